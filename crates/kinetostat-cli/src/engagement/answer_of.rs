//! The answer from the forces and from what is left of the stock.

use kinetostat_cutting::Stock;
use kinetostat_machining::{
    CuttingTool, EngagementSource, ForceAlongPath, Warning, cutting_result, marked_as_compensated,
    of_program,
};

use crate::engagement::answer::{EngagementAnswer, StockAnswer, ToolAnswer};
use crate::job::cut::CutSetup;
use crate::job::cut::along::warnings;
use crate::job::program::ReadProgram;
use crate::job::setting::Setting;
use crate::program::flat_lines::of_warnings;

pub(crate) fn answer_of(
    setting: &Setting,
    cut: &CutSetup,
    (read, forces): (&ReadProgram<'_>, &ForceAlongPath),
    left: Option<&Stock>,
) -> EngagementAnswer {
    let path = read.path();
    let mut files = setting.program_files.clone();
    files.extend(setting.job_file.clone());
    files.extend(cut.files.read.iter().cloned());
    let cuts = path.moves.iter();
    let cuts = cuts.filter(|m| m.is_known_feed());
    let mut assumed = cut.words.clone();
    assumed.push(
        "model, placement and tool lengths of a job play no part: the program is cut where and as large as it is written, with the tool along z; tool and part are rigid".to_owned(),
    );
    let mut warned: Vec<Warning> = warnings(Some(forces));
    warned.extend(read.with(marked_as_compensated));
    // Corrections do not apply here: every tool has its own cutter.
    let of_corrections = |w: &Warning| w.message.contains("corrections are made for one tool");
    warned.extend(
        of_program(path, None)
            .into_iter()
            .filter(|w| !of_corrections(w)),
    );
    EngagementAnswer {
        schema: 1,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        program: setting.program_name.clone(),
        flat: setting.flat.clone(),
        material: cut.material.clone(),
        files,
        tools: cut.question.tools.iter().map(tool).collect(),
        feed_length_mm: cuts.map(kinetostat_program::Move::length_mm).sum(),
        stock: stock(&cut.question.engagement, left),
        cutting: cutting_result(forces, path),
        assumed,
        warnings: of_warnings(warned, setting.flat.as_ref()),
    }
}

fn tool(of: &CuttingTool) -> ToolAnswer {
    ToolAnswer {
        number: of.number,
        shape: of.tool.shape().word(),
        diameter_mm: of.tool.diameter_mm(),
        teeth: of.tool.teeth(),
        helix_deg: of.tool.helix().to_degrees(),
    }
}

fn stock(source: &EngagementSource, left: Option<&Stock>) -> Option<StockAnswer> {
    let (EngagementSource::Stock(whole), Some(left)) = (source, left) else {
        return None;
    };
    let volume = whole.volume_mm3();
    let removed = volume - left.volume_mm3();
    Some(StockAnswer {
        volume_mm3: volume,
        removed_mm3: removed,
        removed_percent: 100.0 * removed / volume,
        cell_mm: whole.cell_mm(),
    })
}
