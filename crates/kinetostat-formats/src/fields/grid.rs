//! Quantities on a grid of places, and as classic NetCDF: xarray, scipy and all of the climate's tools read it.

use netcdf3::{DataSet, FileWriter, Version};

/// An axis of a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldAxis {
    /// Name of the axis, as in `x`.
    pub name: String,
    /// Unit of the coordinates.
    pub unit: String,
    /// Places along it, rising.
    pub places: Vec<f64>,
}

/// A column of numbers, one for each place.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldColumn {
    /// Name: letters, digits and `_`.
    pub name: String,
    /// Unit of the values.
    pub unit: String,
    /// Description of the quantity.
    pub description: String,
    /// A number for each place.
    pub values: Vec<f64>,
}

/// Quantities on a grid; the first axis runs fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct Fields {
    /// Title: the subject of the data.
    pub title: String,
    /// Facts about all of it, name and text.
    pub facts: Vec<(String, String)>,
    /// x, y and z.
    pub axes: [FieldAxis; 3],
    /// Quantities.
    pub columns: Vec<FieldColumn>,
}

/// Error that prevents a file from being made.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct FieldError(pub String);

impl Fields {
    /// Number of places.
    #[must_use]
    pub fn len(&self) -> usize {
        self.axes.iter().map(|axis| axis.places.len()).product()
    }

    /// True without places.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Coordinates of all places along an axis.
    #[cfg(feature = "parquet")]
    pub(crate) fn coordinates(&self, axis: usize) -> Vec<f64> {
        let counts = self.axes.each_ref().map(|axis| axis.places.len());
        let stride: usize = counts[..axis].iter().product();
        let at = |place: usize| self.axes[axis].places[place / stride % counts[axis]];
        (0..self.len()).map(at).collect()
    }

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
