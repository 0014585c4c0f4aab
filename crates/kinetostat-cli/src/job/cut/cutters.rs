//! The cutters of a job: stated in it, or from tables of tools.

use std::path::Path;

use kinetostat_cutting::{LinuxCncTable, MachineUnit, Tool, ToolEntry, ToolTable, WrittenTool};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_program::Program;
use serde_spanned::Spanned;

use crate::files::input_files::InputFiles;
use crate::job::arguments::ProgramArgs;
use crate::job::cut::files_of_cut::FilesOfCut;
use crate::job::cut_tables::CuttersTable;
use crate::job::job_file::JobFile;
use crate::job::setting::program_path;
use crate::job::units_word::UnitsWord;
use crate::ui::failure::{Answer, Failing};
use crate::ui::numbers::short;

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
    pub(crate) fn of_entry(number: Option<u32>, entry: &ToolEntry) -> Self {
        Self {
            number,
            tool: entry.tool,
            rake_deg: entry.rake_deg,
            max_chip_mm: entry.max_chip_mm,
            reach_mm: entry.flute_length_mm.or(entry.stick_out_mm),
        }
    }
}

/// Smallest and largest of several tools, by their diameters.
#[derive(Clone, Copy)]
pub(crate) struct ToolRange<'a> {
    pub(crate) smallest: &'a Tool,
    pub(crate) largest: &'a Tool,
}

impl<'a> ToolRange<'a> {
    /// Returns `None` without a cutter.
    pub(crate) fn of(cutters: &'a [Cutter]) -> Option<Self> {
        let by_diameter = |a: &&Tool, b: &&Tool| a.diameter_mm().total_cmp(&b.diameter_mm());
        let edges = || cutters.iter().map(|cutter| &cutter.tool);
        Some(Self {
            smallest: edges().min_by(by_diameter)?,
            largest: edges().max_by(by_diameter)?,
        })
    }

    /// True if the tools have different diameters.
    pub(crate) fn is_mixed(self) -> bool {
        self.smallest.diameter_mm() < self.largest.diameter_mm()
    }
}

/// The cutters of a job, by the numbers of the tools: those that it states, and those of its table that the program calls;
/// what was taken for granted goes to `words`.
pub(crate) fn cutters(
    files: &InputFiles,
    j: &JobFile,
    flags: &ProgramArgs,
    files_read: &mut FilesOfCut,
    words: &mut Vec<String>,
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
        stands_out_of_its_length(j, number, cutter, entry.as_ref().ok())?;
        entry
            .map(|entry| Cutter::of_entry(number, &entry))
            .map_err(|error| ErrorCode::FileForm.failure(error))
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
        for (number, entry) in called(files, &path, &table)? {
            if all.iter().any(|own| own.number == Some(number)) {
                continue;
            }
            match entry {
                Some(entry) => {
                    words.extend(other_length(j, number, entry));
                    all.push(Cutter::of_entry(Some(number), entry));
                }
                // T0 is no tool.
                None if number != 0 && j.job.tool.cutter.is_some() => words.push(format!(
                    "tool {number} of the program is not in the table of tools: the cutter under [tool] is taken for it"
                )),
                // A tool that cuts, and of which nothing is known, is named with its line where it cuts.
                None => {}
            }
        }
    }
    Ok(all)
}

/// A tool cannot stand farther out of its holder than the holder's flange is away.
fn stands_out_of_its_length(
    j: &JobFile,
    number: Option<u32>,
    cutter: &Spanned<WrittenTool>,
    entry: Option<&ToolEntry>,
) -> Answer<()> {
    let mut own = j.job.tools.iter().map(Spanned::get_ref);
    let length = match number {
        Some(number) => own
            .find(|tool| tool.number == number)
            .and_then(|tool| tool.length_mm.as_ref()),
        None => j.job.tool.length_mm.as_ref(),
    };
    let out = entry.and_then(|entry| entry.stick_out_mm);
    match (length.map(|length| *length.get_ref()), out) {
        (Some(length), Some(out)) if length > 0.0 && out > length => Err(j.error(
            cutter,
            &format!("the cutter stands {} mm out of its holder, and the whole tool is {} mm long", short(out), short(length)),
            "length_mm is that from the flange to the tip; stick_out_mm that from the holder to the tip",
        )),
        _ => Ok(()),
    }
}

/// Lengths that differ by more than this, mm, are said.
const SAME_LENGTH_MM: f64 = 1e-3;

/// Warning if the tool table has another length of a tool than the job, which the kinematics uses.
fn other_length(j: &JobFile, number: u32, entry: &ToolEntry) -> Option<String> {
    let in_table = entry.length_mm?;
    let own = j.job.tools.iter().map(Spanned::get_ref);
    let (length, pose) = match own.into_iter().find(|tool| tool.number == number) {
        Some(tool) => (&tool.length_mm, &tool.pose),
        None => (&j.job.tool.length_mm, &j.job.tool.pose),
    };
    let in_job = match (length, pose) {
        (Some(length), _) => *length.get_ref(),
        (None, None) => 0.0,
        (None, Some(_)) => return None,
    };
    ((in_table - in_job).abs() > SAME_LENGTH_MM).then(|| {
        format!(
            "tool {number} is {} mm long in the table of tools and {} mm in the job: the machine has that of the job",
            short(in_table),
            short(in_job)
        )
    })
}

/// The tools that a program calls, with their entries in a table.
pub(crate) fn called<'t>(
    files: &InputFiles,
    program: &Path,
    table: &'t ToolTable,
) -> Answer<Vec<(u32, Option<&'t ToolEntry>)>> {
    let program = Program::read(files.bytes("program", program)?)
        .map_err(|error| ErrorCode::FileForm.failure(error))?;
    let numbers = program.tool_numbers().into_iter();
    Ok(numbers
        .map(|number| (number, table.tool(number).ok()))
        .collect())
}

/// The table of tools, completed by that of the machine.
fn table_of(
    files: &InputFiles,
    j: &JobFile,
    table: &CuttersTable,
    files_read: &mut FilesOfCut,
) -> Answer<ToolTable> {
    let (text, name) = files_read.text(files, j, "table of tools", &table.file)?;
    let Some(machine) = &table.tool_tbl else {
        return ToolTable::read(&name, &text).map_err(|error| ErrorCode::FileForm.failure(error));
    };
    let (bytes, of_machine) = files_read.bytes(files, j, "table of the machine", machine)?;
    let unit = match table.tool_tbl_unit {
        Some(UnitsWord::Inch) => MachineUnit::Inches,
        Some(UnitsWord::Mm) | None => MachineUnit::Millimetres,
    };
    let machine = LinuxCncTable::read(&of_machine, &bytes, unit)
        .map_err(|error| ErrorCode::FileForm.failure(error))?;
    ToolTable::completing(&name, &text, machine).map_err(|error| ErrorCode::FileForm.failure(error))
}
