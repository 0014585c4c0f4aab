//! The material of a job.

use std::sync::Arc;

use kinetostat_cutting::{Applied, Correction, Materials};

use crate::files::input_files::InputFiles;
use crate::job::cut::files_of_cut::FilesOfCut;
use crate::job::cut::refused;
use crate::job::cut_tables::MaterialTable;
use crate::job::job_file::JobFile;
use crate::ui::failure::{Answer, Failure};

/// The law of the material with its factors, and what was assumed.
pub(super) struct MaterialSetup {
    pub(super) applied: Arc<Applied>,
    pub(super) words: Vec<String>,
}

pub(super) fn material(
    files: &InputFiles,
    job: &JobFile,
    table: &MaterialTable,
    read: &mut FilesOfCut,
) -> Answer<MaterialSetup> {
    let mut known = Materials::library();
    if let Some(file) = &table.file {
        let (text, name) = read.text(files, job, "file of materials", file.get_ref())?;
        known.with(Materials::read(&name, &text).map_err(Failure::input)?);
    }
    let found = known.find(table.name.get_ref());
    let found = found.map_err(|error| refused(job, &table.name, &error))?;
    let correction = Correction {
        process: table.process_factor,
        cutting_speed_m_per_min: table.cutting_speed_m_per_min,
        rake_deg: table.rake_deg,
        cutting_material: table.cutting_material,
        wear: table.wear_factor,
        coolant: table.coolant,
        ..Correction::default()
    };
    let applied = found
        .for_milling(&correction)
        .map_err(|error| refused(job, &table.name, &error))?;
    let mut words = vec![
        format!("material {}: {}", found.name, found.law.description()),
        format!("source: {}", found.source),
    ];
    words.extend(found.assumptions.iter().cloned());
    words.extend(applied.factors.iter().map(|f| format!("factor {f}")));
    words.push(format!(
        "the force may be {:.0} % more or less than stated",
        100.0 * applied.spread
    ));
    Ok(MaterialSetup {
        applied: Arc::new(applied),
        words,
    })
}
