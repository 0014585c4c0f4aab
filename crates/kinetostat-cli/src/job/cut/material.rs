//! The material of a job.

use kinetostat_cutting::{Applied, Correction, Material, Materials};
use serde_spanned::Spanned;

use crate::files::input_files::InputFiles;
use crate::job::cut::files_of_cut::FilesOfCut;
use crate::job::cut::refused::refused;
use crate::job::cut_tables::MaterialTable;
use crate::job::job_file::JobFile;
use crate::ui::failure::{Answer, Failure};

/// The material, how it is cut, and what was assumed.
pub(super) struct MaterialSetup {
    material: Material,
    correction: Correction,
    name: Spanned<String>,
    pub(super) words: Vec<String>,
}

impl MaterialSetup {
    /// Its law with the factors for a tool: the rake of its edges, where the job states none for all.
    pub(super) fn for_tool(
        &self,
        job: &JobFile,
        number: Option<u32>,
        rake_deg: Option<f64>,
        words: &mut Vec<String>,
    ) -> Answer<Applied> {
        let own = self.correction.rake_deg.is_none() && rake_deg.is_some();
        let correction = Correction {
            rake_deg: self.correction.rake_deg.or(rake_deg),
            ..self.correction
        };
        let applied = self.material.for_milling(&correction);
        let applied = applied.map_err(|error| refused(job, &self.name, &error))?;
        if own {
            let tool = number.map_or_else(|| "the tool".to_owned(), |n| format!("tool {n}"));
            let all = applied.factors.iter();
            let of_rake = all.filter(|factor| factor.symbol == "K_gamma");
            words.extend(of_rake.map(|factor| format!("{tool}: factor {factor}")));
        }
        Ok(applied)
    }
}

pub(super) fn material(
    files: &InputFiles,
    job: &JobFile,
    table: &MaterialTable,
    read: &mut FilesOfCut,
) -> Answer<MaterialSetup> {
    let mut known = Materials::library();
    if let Some(file) = &table.file {
        let (text, name) = read.text(files, job, "file of materials", file)?;
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
        material: found.clone(),
        correction,
        name: table.name.clone(),
        words,
    })
}
