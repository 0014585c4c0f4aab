//! The material of a job.

use std::sync::Arc;

use kinetostat_cutting::{Correction, CutError, Material, Materials};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::CuttingTool;

use crate::files::input_files::InputFiles;
use crate::job::cut::cutters::Cutter;
use crate::job::cut::files_of_cut::FilesOfCut;
use crate::job::cut::refused::refused;
use crate::job::cut_tables::MaterialTable;
use crate::job::job_file::JobFile;
use crate::ui::failure::{Answer, Failing};

/// The material, how it is cut, and what was assumed.
pub(crate) struct MaterialSetup {
    material: Material,
    correction: Correction,
    pub(crate) words: Vec<String>,
}

impl MaterialSetup {
    /// A material that is cut under these conditions.
    ///
    /// # Errors
    /// Factors that nobody measured.
    pub(crate) fn new(material: &Material, correction: Correction) -> Result<Self, CutError> {
        let applied = material.for_milling(&correction)?;
        let mut words = vec![
            format!("material {}: {}", material.name, material.law.description()),
            format!("source: {}", material.source),
        ];
        words.extend(material.assumptions.iter().cloned());
        words.extend(applied.factors.iter().map(|f| format!("factor {f}")));
        words.push(format!(
            "the force may be {:.0} % more or less than stated",
            100.0 * applied.spread
        ));
        Ok(Self {
            material: material.clone(),
            correction,
            words,
        })
    }

    pub(crate) fn name(&self) -> &str {
        &self.material.name
    }

    /// A tool with its law: with the rake of its edges, where none is stated for all.
    pub(crate) fn for_tool(
        &self,
        cutter: &Cutter,
        words: &mut Vec<String>,
    ) -> Result<CuttingTool, CutError> {
        let own = self.correction.rake_deg.is_none() && cutter.rake_deg.is_some();
        let correction = Correction {
            rake_deg: self.correction.rake_deg.or(cutter.rake_deg),
            ..self.correction
        };
        let applied = self.material.for_milling(&correction)?;
        if own {
            let tool = cutter
                .number
                .map_or_else(|| "the tool".to_owned(), |n| format!("tool {n}"));
            let all = applied.factors.iter();
            let of_rake = all.filter(|factor| factor.symbol == "K_gamma");
            words.extend(of_rake.map(|factor| format!("{tool}: factor {factor}")));
        }
        Ok(CuttingTool {
            number: cutter.number,
            tool: cutter.tool,
            law: Arc::new(applied.law),
            spread: applied.spread,
            max_chip_mm: cutter.max_chip_mm,
            flute_length_mm: cutter.reach_mm,
        })
    }
}

pub(crate) fn material(
    files: &InputFiles,
    job: &JobFile,
    table: &MaterialTable,
    read: &mut FilesOfCut,
) -> Answer<MaterialSetup> {
    let mut known = Materials::library();
    if let Some(file) = &table.file {
        let (text, name) = read.text(files, job, "file of materials", file)?;
        known.with(
            Materials::read(&name, &text).map_err(|error| ErrorCode::FileForm.failure(error))?,
        );
    }
    let wrong = |error: CutError| refused(job, &table.name, &error);
    let found = known.find(table.name.get_ref()).map_err(wrong)?;
    let correction = Correction {
        process: table.process_factor,
        cutting_speed_m_per_min: table.cutting_speed_m_per_min,
        rake_deg: table.rake_deg,
        cutting_material: table.cutting_material,
        wear: table.wear_factor,
        coolant: table.coolant,
        ..Correction::default()
    };
    MaterialSetup::new(found, correction).map_err(wrong)
}
