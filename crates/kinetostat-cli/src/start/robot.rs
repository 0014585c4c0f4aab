//! The robot: a model that is there, or one that is made of a URDF.

use std::path::{Path, PathBuf};

use kinetostat_import::{Imported, JointStiffness, UrdfOptions, import_urdf, read_text};
use kinetostat_model::schema::AxisName;
use kinetostat_model::{Model, preset_text};

use crate::files::file_kind::FileKind;
use crate::files::file_names::stem;
use crate::files::input_files::InputFiles;
use crate::files::paths::seen_from;
use crate::start::ask::Ask;
use crate::start::reading::wrong;
use crate::ui::failure::Answer;

/// A robot: the name that the job gives to its model, and the text of the model if it is to be written.
#[derive(Clone)]
pub(super) struct Robot {
    pub(super) model: Model,
    pub(super) named: String,
    pub(super) text: Option<String>,
}

impl Robot {
    /// A preset, which is copied, or a model file; `folder` is that of the job.
    pub(super) fn of(named: &str, folder: &Path) -> Answer<Self> {
        let (model, path) = InputFiles::default().model(named, Path::new(""))?;
        model.require_stiffness()?;
        Ok(Self {
            model,
            named: path.map_or_else(|| format!("{named}.toml"), |path| seen_from(folder, &path)),
            text: preset_text(named).map(str::to_owned),
        })
    }
}

/// A URDF on the way to a model.
#[derive(Clone)]
pub(super) struct Urdf {
    file: PathBuf,
    text: String,
    pub(super) tip: Option<String>,
    pub(super) flange_z: Option<AxisName>,
}

impl Urdf {
    /// The URDF of that name, if it is one.
    pub(super) fn of(named: &str) -> Answer<Option<Self>> {
        let path = Path::new(named);
        if preset_text(named).is_some() || FileKind::of_file(path) != Some(FileKind::Urdf) {
            return Ok(None);
        }
        let mut urdf = Self {
            file: path.to_owned(),
            text: read_text("URDF file", path)?,
            tip: None,
            flange_z: None,
        };
        // A chain with one end needs no question.
        let imported = urdf.import(JointStiffness::Unknown);
        urdf.tip = imported.ok().map(|imported| imported.tip);
        Ok(Some(urdf))
    }

    pub(super) fn next(&self) -> Ask {
        match (&self.tip, self.flange_z) {
            (None, _) => Ask::Tip,
            (_, None) => Ask::FlangeAxis,
            _ => Ask::JointStiffness,
        }
    }

    /// The robot with its tool on a link.
    pub(super) fn with_tip(&self, tip: &str) -> Answer<Self> {
        let tip = Some(tip.to_owned());
        let urdf = Self {
            tip,
            ..self.clone()
        };
        urdf.import(JointStiffness::Unknown).map(|_| urdf)
    }

    /// The model with joints of one stiffness, N m/rad, or of those in a table; and what its import had to remark.
    pub(super) fn robot(&self, stiffness: &str) -> Answer<(Robot, String)> {
        let stiffness = match stiffness.parse::<f64>() {
            Ok(value) if value > 0.0 && value.is_finite() => JointStiffness::All(value),
            Ok(_) => return Err(wrong("a stiffness above 0 N m/rad is needed")),
            Err(_) => JointStiffness::Table {
                file: stiffness.to_owned(),
                text: InputFiles::default()
                    .text("table of joint stiffnesses", Path::new(stiffness))?,
            },
        };
        let imported = self.import(stiffness)?;
        imported.model.require_stiffness()?;
        if !imported.rigid_drives.is_empty() {
            return Err(wrong(&format!(
                "the table has no stiffness of {}: they would count as rigid",
                imported.rigid_drives.join(", ")
            )));
        }
        let remarks = imported.notices.iter().chain(&imported.model.warnings);
        let remarks = remarks.map(|n| format!("{} ({}; {})", n.message, n.path, n.help));
        let remarks = remarks.collect::<Vec<_>>().join("\n");
        let robot = Robot {
            model: imported.model,
            named: format!("{}.toml", stem(&self.file)),
            text: Some(imported.toml),
        };
        Ok((robot, remarks))
    }

    fn import(&self, stiffness: JointStiffness) -> Answer<Imported> {
        let mut options = UrdfOptions::default();
        options.tip.clone_from(&self.tip);
        options.flange_z = self.flange_z;
        options.stiffness = stiffness;
        let file = self.file.display().to_string();
        Ok(import_urdf(&self.text, &file, &options)?)
    }
}
