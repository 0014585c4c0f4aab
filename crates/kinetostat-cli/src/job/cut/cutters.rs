//! The cutters of a job: stated in it, or from tables of tools.

use kinetostat_cutting::{LinuxCncTable, MachineUnit, ToolEntry, ToolTable, WrittenTool};
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
use crate::ui::numbers::short;

/// The number of a tool, and its edges; without a number it is that of all others.
type Cutter = (Option<u32>, ToolEntry);

/// The cutters of a job, by the numbers of the tools: those that it states, and those of its table that the program calls;
/// what was taken for granted goes to `words`.
pub(super) fn cutters(
    files: &InputFiles,
    j: &JobFile,
    flags: &ProgramArgs,
    (files_read, words): (&mut FilesOfCut, &mut Vec<String>),
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
        entry.map(|entry| (number, entry)).map_err(Failure::input)
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
        let program = Program::read(files.bytes("program", &path)?).map_err(Failure::input)?;
        for number in program.tool_numbers() {
            if all.iter().any(|(own, _)| *own == Some(number)) {
                continue;
            }
            match table.tool(number) {
                Ok(entry) => {
                    words.extend(other_length(j, number, entry));
                    all.push((Some(number), entry.clone()));
                }
                // T0 is no tool.
                Err(_) if number != 0 && j.job.tool.cutter.is_some() => words.push(format!(
                    "tool {number} of the program is not in the table of tools: the cutter under [tool] is taken for it"
                )),
                // A tool that cuts, and of which nothing is known, is named with its line where it cuts.
                Err(_) => {}
            }
        }
    }
    Ok(all)
}

/// Lengths that differ by more than this, mm, are said.
const SAME_LENGTH_MM: f64 = 1e-3;

/// What is said where the table has another length of a tool than the job, on which the machine stands.
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

/// The table of tools, completed by that of the machine.
fn table_of(
    files: &InputFiles,
    j: &JobFile,
    table: &CuttersTable,
    files_read: &mut FilesOfCut,
) -> Answer<ToolTable> {
    let (text, name) = files_read.text(files, j, "table of tools", &table.file)?;
    let Some(machine) = &table.tool_tbl else {
        return ToolTable::read(&name, &text).map_err(Failure::input);
    };
    let (bytes, of_machine) = files_read.bytes(files, j, "table of the machine", machine)?;
    let unit = match table.tool_tbl_unit {
        Some(UnitsWord::Inch) => MachineUnit::Inches,
        Some(UnitsWord::Mm) | None => MachineUnit::Millimetres,
    };
    let machine = LinuxCncTable::read(&of_machine, &bytes, unit).map_err(Failure::input)?;
    ToolTable::completing(&name, &text, machine).map_err(Failure::input)
}
