//! The cutters of a job: stated in it, or from tables of tools.

use std::path::Path;

use kinetostat_cutting::{LinuxCncTable, MachineUnit, Tool, ToolEntry, ToolTable, WrittenTool};
use kinetostat_program::Program;
use serde_spanned::Spanned;

use crate::files::input_files::InputFiles;
use crate::job::arguments::ProgramArgs;
use crate::job::cut::files_of_cut::FilesOfCut;
use crate::job::cut_tables::CuttersTable;
use crate::job::job_file::JobFile;
use crate::job::setting::program_path;
use crate::job::units_word::UnitsWord;
use crate::ui::failure::{Answer, Failure};

/// The edges of a tool, and what is known beside them.
#[derive(Clone, Debug)]
pub(crate) struct Cutter {
    /// Number by which the program calls it; without one it is the tool of all blocks whose tool has no entry.
    pub(crate) number: Option<u32>,
    pub(crate) tool: Tool,
    pub(crate) rake_deg: Option<f64>,
    pub(crate) max_chip_mm: Option<f64>,
    /// Length of its edges, or outside the holder, mm.
    pub(crate) reach_mm: Option<f64>,
}

impl Cutter {
    fn of_entry(number: Option<u32>, entry: &ToolEntry) -> Self {
        Self {
            number,
            tool: entry.tool,
            rake_deg: entry.rake_deg,
            max_chip_mm: entry.max_chip_mm,
            reach_mm: entry.flute_length_mm.or(entry.stick_out_mm),
        }
    }
}

/// The smallest and the largest of some tools by their diameters; none of none.
pub(crate) fn extremes(cutters: &[Cutter]) -> Option<(&Tool, &Tool)> {
    let by_diameter = |a: &&Tool, b: &&Tool| a.diameter_mm().total_cmp(&b.diameter_mm());
    let edges = || cutters.iter().map(|cutter| &cutter.tool);
    edges().min_by(by_diameter).zip(edges().max_by(by_diameter))
}

/// The cutters of a job, by the numbers of the tools: those that it states, and those of its table that the program calls.
pub(crate) fn cutters(
    files: &InputFiles,
    j: &JobFile,
    flags: &ProgramArgs,
    files_read: &mut FilesOfCut,
) -> Answer<Vec<Cutter>> {
    let tools = &j.job.tools;
    let same = |a: usize, b: usize| tools[a].get_ref().number == tools[b].get_ref().number;
    if let Some(twice) = (0..tools.len()).find(|&i| (0..i).any(|before| same(before, i))) {
        return Err(j.error(
            &tools[twice],
            &format!("tool {} is given twice", tools[twice].get_ref().number),
            "give each number once",
        ));
    }
    let file = j.path.display().to_string();
    let read = |number: Option<u32>, cutter: &Spanned<WrittenTool>| {
        if let Some((key, span)) = cutter.get_ref().key_of_a_table() {
            return Err(j.error(
                &Spanned::new(span, ()),
                &format!("{key} is no part of a cutter in a job"),
                "number and length_mm stand beside it, under [tool] or [[tools]]",
            ));
        }
        let entry = ToolEntry::written(&file, &j.text, number.unwrap_or(0), cutter);
        entry
            .map(|entry| Cutter::of_entry(number, &entry))
            .map_err(Failure::input)
    };
    let one = j.job.tool.cutter.iter().map(|cutter| read(None, cutter));
    let numbered = j.job.tools.iter().filter_map(|tool| {
        let tool = tool.get_ref();
        tool.cutter
            .as_ref()
            .map(|cutter| read(Some(tool.number), cutter))
    });
    let mut all: Vec<Cutter> = one.chain(numbered).collect::<Answer<_>>()?;
    if let Some(table) = &j.job.cutters {
        let table = table_of(files, j, table.get_ref(), files_read)?;
        let path = program_path(Some(j), flags)?;
        for cutter in called(files, &path, &table)? {
            if !all.iter().any(|own| own.number == cutter.number) {
                all.push(cutter);
            }
        }
    }
    Ok(all)
}

/// The tools of a table that a program calls. One that cuts and is not in the table is named with its line where it cuts.
pub(crate) fn called(files: &InputFiles, program: &Path, table: &ToolTable) -> Answer<Vec<Cutter>> {
    let program = Program::read(files.bytes("program", program)?).map_err(Failure::input)?;
    let numbers = program.tool_numbers().into_iter();
    let known = numbers.filter_map(|number| {
        let entry = table.tool(number).ok()?;
        Some(Cutter::of_entry(Some(number), entry))
    });
    Ok(known.collect())
}

/// The table of tools, completed by that of the machine.
fn table_of(
    files: &InputFiles,
    j: &JobFile,
    table: &CuttersTable,
    files_read: &mut FilesOfCut,
) -> Answer<ToolTable> {
    let (text, name) = files_read.text(files, j, "table of tools", table.file.get_ref())?;
    let Some(machine) = &table.tool_tbl else {
        return ToolTable::read(&name, &text).map_err(Failure::input);
    };
    let (bytes, of_machine) =
        files_read.bytes(files, j, "table of the machine", machine.get_ref())?;
    let unit = match table.tool_tbl_unit {
        Some(UnitsWord::Inch) => MachineUnit::Inches,
        Some(UnitsWord::Mm) | None => MachineUnit::Millimetres,
    };
    let machine = LinuxCncTable::read(&of_machine, &bytes, unit).map_err(Failure::input)?;
    ToolTable::completing(&name, &text, machine).map_err(Failure::input)
}
