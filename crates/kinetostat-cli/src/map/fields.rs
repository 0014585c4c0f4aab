//! A map as files of other programs: VTK, NetCDF, Parquet.

use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::fields::{FieldAxis, FieldColumn, Fields};
use kinetostat_machining::{Grid, MapPlace};

use crate::map::columns::Column;
use crate::map::query::AXES;
use crate::ui::failure::{Answer, Failing};

/// Columns of a map, SI, gathered place by place.
pub(crate) struct Gathering {
    fields: Fields,
    loaded: bool,
}

impl Gathering {
    pub(crate) fn new(
        title: String,
        facts: Vec<(String, String)>,
        grid: &Grid,
        loaded: bool,
        further: &[Column],
    ) -> Self {
        let axes = [0, 1, 2].map(|k| FieldAxis {
            name: AXES[k].to_owned(),
            unit: "m".to_owned(),
            places: (0..grid.counts[k])
                .map(|i| 1e-3 * grid.position_mm(k, i))
                .collect(),
        });
        let own = |name: &str, unit: &str, description: &str| FieldColumn {
            name: name.to_owned(),
            unit: unit.to_owned(),
            description: description.to_owned(),
            values: Vec::with_capacity(grid.len()),
        };
        let states = "0 regular, 1 singular, 2 not stable, 3 outside the limits of an actuator, 4 cannot be reached, 5 no equilibrium";
        let mut columns = vec![own("state", "1", states)];
        for name in ["softest", "x", "y", "z"] {
            let name = format!("stiffness_{name}");
            let description = kinetostat_machining::Variable::named(&name)
                .map_or("", |variable| variable.entry().description);
            columns.push(own(&name, "N/m", description));
        }
        if loaded {
            for axis in AXES {
                columns.push(own(
                    &format!("deflection_{axis}"),
                    "m",
                    "from where the tool is commanded to where it goes under the load, base axes",
                ));
            }
            for axis in AXES {
                columns.push(own(
                    &format!("rotation_{axis}"),
                    "rad",
                    "rotation vector of the tool under the load, base axes",
                ));
            }
        }
        for column in further {
            columns.push(own(&column.name, column.unit, column.description));
        }
        let mut own = Self {
            fields: Fields {
                title,
                facts,
                axes,
                columns,
            },
            loaded,
        };
        own.only_once();
        own
    }

    /// A column that was asked for beside the usual ones stays once: the later one is dropped when it is written.
    fn only_once(&mut self) {
        for k in (0..self.fields.columns.len()).rev() {
            let name = self.fields.columns[k].name.clone();
            if self.fields.columns[..k].iter().any(|c| c.name == name) {
                self.fields.columns[k].name.clear();
            }
        }
    }

    pub(crate) fn take(&mut self, place: &MapPlace) {
        let mut columns = self.fields.columns.iter_mut();
        let mut put = |value: f64| {
            if let Some(column) = columns.next() {
                column.values.push(value);
            }
        };
        put(place.state as u8 as f64);
        put(1e3 * place.smallest_stiffness_n_per_mm);
        let stiffness = place.stiffness_n_per_mm.iter();
        stiffness.for_each(|k| put(1e3 * k));
        if self.loaded {
            place.displacement_mm.iter().for_each(|d| put(1e-3 * d));
            let turned = place.rotation_deg.iter();
            turned.for_each(|d| put(d.to_radians()));
        }
        place.values.iter().for_each(|value| put(*value));
    }

    /// All of them, each name once.
    pub(crate) fn done(mut self) -> Fields {
        self.fields.columns.retain(|c| !c.name.is_empty());
        self.fields
    }
}

/// A NetCDF file as bytes: its crate writes to a path.
pub(crate) fn netcdf(fields: &Fields) -> Answer<Vec<u8>> {
    let part = tempfile::NamedTempFile::new().map_err(|error| ErrorCode::Output.failure(error))?;
    fields
        .write_netcdf(part.path())
        .map_err(|error| ErrorCode::Output.failure(error))?;
    std::fs::read(part.path()).map_err(|error| ErrorCode::Output.failure(error))
}
