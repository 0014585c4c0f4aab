//! Classic NetCDF: xarray, scipy and all of the climate's tools read it.

use netcdf3::{DataSet, FileWriter, Version};

use crate::fields::grid::{FieldError, Fields};

impl Fields {
    /// Writes a NetCDF-3 file with offsets of 64 bits: dimensions z, y, x, a variable for each axis and column.
    ///
    /// # Errors
    /// The file cannot be written, or a name is none of NetCDF.
    pub fn write_netcdf(&self, path: &std::path::Path) -> Result<(), FieldError> {
        let set = self
            .definition()
            .map_err(|e| FieldError(format!("{e:?}")))?;
        let written = (|| {
            let mut file = FileWriter::open(path)?;
            file.set_def(&set, Version::Offset64Bit, 0)?;
            for axis in &self.axes {
                file.write_var_f64(&axis.name, &axis.places)?;
            }
            for column in &self.columns {
                file.write_var_f64(&column.name, &column.values)?;
            }
            file.close()
        })();
        written.map_err(|e| FieldError(format!("{e:?}")))
    }

    fn definition(&self) -> Result<DataSet, netcdf3::InvalidDataSet> {
        let mut set = DataSet::new();
        set.add_global_attr_string("title", &self.title)?;
        set.add_global_attr_string("Conventions", "CF-1.8")?;
        for (name, text) in &self.facts {
            set.add_global_attr_string(name, text)?;
        }
        for axis in &self.axes {
            set.add_fixed_dim(&axis.name, axis.places.len())?;
        }
        for axis in &self.axes {
            set.add_var_f64(&axis.name, &[&axis.name])?;
            set.add_var_attr_string(&axis.name, "units", &axis.unit)?;
        }
        let slowest_first: Vec<&String> = self.axes.iter().rev().map(|axis| &axis.name).collect();
        for column in &self.columns {
            set.add_var_f64(&column.name, &slowest_first)?;
            set.add_var_attr_string(&column.name, "units", &column.unit)?;
            set.add_var_attr_string(&column.name, "long_name", &column.description)?;
        }
        Ok(set)
    }
}
