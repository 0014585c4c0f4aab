//! The files of a map: the table, the drawing, and the fields for other programs.

use std::path::Path;

use kinetostat_formats::fields::Fields;
use kinetostat_machining::MapTask;

use crate::files::outputs::Outputs;
use crate::map::answer::MapAnswer;
use crate::map::arguments::MapArgs;
use crate::map::fields::{Gathering, netcdf};
use crate::map::over;
use crate::map::picture::Picture;
use crate::ui::failure::{Answer, Failure};

/// Places of the files among the outputs.
pub(crate) struct Files {
    pub(crate) csv: Option<usize>,
    plot: Option<usize>,
    vtk: Option<usize>,
    netcdf: Option<usize>,
    parquet: Option<usize>,
}

impl Files {
    /// Claims what the options name.
    pub(crate) fn claimed(args: &MapArgs, outputs: &mut Outputs) -> Answer<Self> {
        let mut claim =
            |what, path: Option<&Path>| path.map(|p| outputs.claim(what, p)).transpose();
        Ok(Self {
            csv: claim("table", args.csv.as_deref())?,
            plot: claim("plot", args.plot.as_deref())?,
            vtk: claim("VTK file", args.vtk.as_deref())?,
            netcdf: claim("NetCDF file", args.netcdf.as_deref())?,
            parquet: claim("Parquet file", args.parquet.as_deref())?,
        })
    }

    /// True if fields are gathered.
    pub(crate) fn want_fields(&self) -> bool {
        self.vtk.is_some() || self.netcdf.is_some() || self.parquet.is_some()
    }

    /// Draws the section.
    pub(crate) fn draw(
        &self,
        outputs: &mut Outputs,
        (task, answer, picture): (&MapTask<'_>, &MapAnswer, &Picture),
    ) -> Answer<()> {
        let Some(index) = self.plot else {
            return Ok(());
        };
        let mut lines = over::isolines(picture);
        lines.extend(over::outline(task, picture));
        let marks = over::extremes(picture);
        outputs.fill(index, picture.svg(answer, lines, marks).as_bytes())
    }

    /// Writes the fields in the forms that are asked for.
    pub(crate) fn write_fields(
        &self,
        outputs: &mut Outputs,
        gathering: Option<Gathering>,
    ) -> Answer<()> {
        let Some(fields) = gathering.map(Gathering::done) else {
            return Ok(());
        };
        if let Some(index) = self.vtk {
            outputs.fill(index, &fields.vtk())?;
        }
        if let Some(index) = self.netcdf {
            outputs.fill(index, &netcdf(&fields)?)?;
        }
        if let Some(index) = self.parquet {
            outputs.fill(index, &parquet_of(&fields)?)?;
        }
        Ok(())
    }
}

#[cfg(feature = "parquet")]
fn parquet_of(fields: &Fields) -> Answer<Vec<u8>> {
    fields.parquet().map_err(Failure::input)
}

#[cfg(not(feature = "parquet"))]
fn parquet_of(_: &Fields) -> Answer<Vec<u8>> {
    Err(Failure::input(
        "--parquet: this program was built without Parquet",
    ))
}
