//! The reader of KRL programs, and the names of a program: data and routines of all files; `.src` and `.dat` of one name are one module.

use std::collections::BTreeMap;

use crate::error::ProgramError;
use crate::interpreter::flat::flat_of;
use crate::interpreter::symbols::Symbols;
use crate::interpreter::token::{Kind, TokenFile};
use crate::interpreter::tree::{Change, DatumNode, Sight};
use crate::krl::lex::{not_paired, token_file};
use crate::krl::parser::blocks::Content;
use crate::krl::parser::routines::content_of;
use crate::krl::state::Krl;
use crate::model::Language;
use crate::model::parsed::{Parsed, Read};
use crate::model::program::RobotProgram;
use crate::options::{ExternalAxes, ReadOptions};
use crate::text::Name;
use crate::text::source::{Finding, FlatText, SourceFile};

/// Limit of the bytes of a file; the memory needed is some forty times as much.
const MOST_BYTES: usize = 1 << 28;

/// Reads KRL programs (`.src`) with their data (`.dat`) together; `$config.dat` for tools, bases and home positions if given.
///
/// Files of one name are one module. The program begins with the first routine of the first `.src` file that no other
/// calls. Bases and tools that neither the statements nor the data say are those that [`ReadOptions::frames`] states as
/// `BASE_DATA[1]`, `TOOL_DATA[1]`, or `$BASE` and `$TOOL` for where nothing sets them. Splines through points (SPL), joint splines, motions of
/// sensors and ends computed at run time are refused, as are external axes that move unless the options carry them. The text of
/// FOLDs is carried and never trusted; where it contradicts its statements a finding says so.
///
/// ```
/// use kinetostat_formats::{MotionKind, ReadOptions, SourceFile, Zone, read_krl};
///
/// let source = "DEF groove()\nBAS(#INITMOV,0)\n$BASE=BASE_DATA[1]\n$TOOL={X 0,Y 0,Z 150,A 0,B 0,C 0}\n\
///     $VEL.CP=0.02\n$APO.CDIS=1\nPTP start:{X 0,Y 0,Z -50,A 0,B 0,C 0} ; above\nLIN Start C_DIS\nEND\n";
/// let data = "DEFDAT groove\nDECL E6POS START={X 100,Y 0,Z 0,A 0,B 0,C 180,S 2,T 35}\nENDDAT\n";
/// let files = vec![SourceFile::new("groove.src", source), SourceFile::new("groove.dat", data)];
/// let program = read_krl(files, &ReadOptions::default()).unwrap();
/// assert_eq!(program.motions.len(), 2);
/// let motion = &program.motions[1];
/// assert_eq!((&motion.kind, motion.zone, motion.follows), (&MotionKind::Linear, Zone::Radius(1.0), Some(0)));
/// assert_eq!(motion.speed.mm_per_s, Some(20.0));
/// assert_eq!(motion.tool.known().unwrap().translation.z, 150.0);
/// // A sum is in the axes of what is added to: this tool points down.
/// assert!((program.motions[0].target.pose().unwrap().position_mm.z - 50.0).abs() < 1e-9);
/// ```
///
/// # Errors
/// All that is refused, in the order of files and lines.
pub fn read_krl(
    files: Vec<SourceFile>,
    options: &ReadOptions,
) -> Result<RobotProgram, Vec<ProgramError>> {
    parse_krl(files, options).without_faults()
}

/// Reads all that can be read of KRL programs.
pub(crate) fn parse_krl(files: Vec<SourceFile>, options: &ReadOptions) -> Parsed {
    let large = |file: &SourceFile| ProgramError::too_large(file, MOST_BYTES);
    let mut faults: Vec<ProgramError> = files.iter().filter_map(large).collect();
    if !faults.is_empty() {
        return Parsed::refused(Language::Krl, faults);
    }
    let token_files = token_files(&files);
    let contents = contents_of(&token_files, &mut faults);
    let symbols = symbols_of(&token_files, &contents, &mut faults);
    let run = Krl::run(&token_files, &symbols, options).whole();
    faults.extend(run.faults);
    let mut findings = run.findings;
    for file in &token_files {
        findings.extend(not_paired(file).into_iter().map(|(line, what)| Finding {
            file: file.index,
            line,
            message: format!(
                "{what}: it is carried, but the pendant shows other FOLDs than are meant"
            ),
        }));
    }
    let read = Read {
        motions: run.motions,
        declarations: run.targets.declarations,
        findings,
        outside_calls: run.outside_calls,
        ran: run.ran_beside,
        faults,
        external_axes_may_move: options.external_axes != ExternalAxes::Refused,
        moving_calls: &options.moving_calls,
    };
    let mut parsed = Parsed::of_robot(Language::Krl, files, read);
    parsed.program.values = options.values.clone();
    parsed
}

/// Runs a program once and writes it flat: the statements of its run, one after the other, in place of those of its first routine. Data lists
/// stay beside it.
pub(crate) fn expand_krl(
    files: &[SourceFile],
    options: &ReadOptions,
) -> Result<FlatText, Vec<ProgramError>> {
    let mut faults = Vec::new();
    let token_files = token_files(files);
    let contents = contents_of(&token_files, &mut faults);
    let symbols = symbols_of(&token_files, &contents, &mut faults);
    flat_of(Krl::run(&token_files, &symbols, options), files, faults)
}

/// True for a file that holds no routine.
pub(crate) fn is_data_list(file: &SourceFile) -> bool {
    let tokens = token_file(0, file);
    content_of(&tokens, &mut Vec::new()).routines.is_empty()
}

fn token_files(files: &[SourceFile]) -> Vec<TokenFile<'_>> {
    let all = files.iter().enumerate();
    all.map(|(index, source)| token_file(index, source))
        .collect()
}

/// Parses each file.
fn contents_of(files: &[TokenFile<'_>], faults: &mut Vec<ProgramError>) -> Vec<Content> {
    let mut contents: Vec<Content> = Vec::with_capacity(files.len());
    for file in files {
        let before = faults.len();
        let content = content_of(file, faults);
        if content.routines.is_empty() && content.list.is_none() && faults.len() == before {
            faults.push(ProgramError::at(
                file.source,
                0..0,
                "there is no DEF and no DEFDAT in the file",
                "give a .src or .dat file as the controller saves it",
            ));
        }
        contents.push(content);
    }
    complete(files, &mut contents);
    contents
}

/// The name of a file without folders and extension, in capitals.
fn stem(file: &TokenFile<'_>) -> String {
    let name = file.source.name();
    let name = name.rsplit(['/', '\\']).next().unwrap_or(name);
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    stem.to_uppercase()
}

/// Completes the contents of files: what stands in `$config.dat` is seen everywhere, as is the first routine of a file, and what the system
/// declares has a declaration.
pub(super) fn complete(files: &[TokenFile<'_>], contents: &mut [Content]) {
    for (file, content) in files.iter().zip(contents.iter_mut()) {
        let is_config =
            stem(file) == "$CONFIG" || content.list.is_some_and(|name| name.is("$CONFIG"));
        if is_config {
            for node in &mut content.data {
                node.sight = Sight::Everywhere;
            }
        }
    }
    let mut declared: Vec<(String, Name)> = Vec::new();
    for (file, content) in files.iter().zip(contents.iter()) {
        let own = content.data.iter().map(|node| {
            let home = match node.sight {
                Sight::Everywhere => String::new(),
                Sight::Module => stem(file),
            };
            (home, node.name)
        });
        declared.extend(own);
    }
    for (file, content) in files.iter().zip(contents.iter_mut()) {
        let home = stem(file);
        for preset in &content.presets {
            let is_it = |(of, name): &(String, Name)| {
                *name == preset.name && (of.is_empty() || *of == home)
            };
            if declared.iter().any(is_it) {
                continue;
            }
            declared.push((String::new(), preset.name));
            content.data.push(DatumNode {
                change: Change::Variable,
                sight: Sight::Everywhere,
                type_name: Name::of(b"E6POS").unwrap_or(preset.name),
                name: preset.name,
                name_at: preset.name_at,
                tokens: preset.tokens.clone(),
                initial: None,
                dimensions: None,
                is_alone: false,
            });
        }
    }
}

/// The names of the content of each file.
pub(super) fn symbols_of<'p>(
    files: &[TokenFile<'_>],
    contents: &'p [Content],
    faults: &mut Vec<ProgramError>,
) -> Symbols<'p> {
    let mut all = Symbols::default();
    let mut modules: BTreeMap<String, usize> = BTreeMap::new();
    let mut firsts = Vec::new();
    for (file, content) in files.iter().zip(contents) {
        let stem = stem(file);
        let module = all.add_module(file.index, modules.get(&stem).copied());
        modules.entry(stem).or_insert(module);
        for node in &content.data {
            all.add_datum(file, module, node, faults);
        }
        for preset in &content.presets {
            all.add_element(file.index, module, preset);
        }
        for (number, routine) in content.routines.iter().enumerate() {
            all.add_routine(file, module, routine, faults);
            if number == 0 {
                firsts.push(all.routines.len() - 1);
                all.see_everywhere(all.routines.len() - 1);
            }
        }
    }
    all.main = main_of(files, &all, &firsts);
    all
}

/// The first routine of the first file that no other calls.
fn main_of(files: &[TokenFile<'_>], all: &Symbols<'_>, firsts: &[usize]) -> Option<usize> {
    let mut called = vec![false; all.routines.len()];
    for (index, home) in all.routines.iter().enumerate() {
        let file = &files[home.file];
        home.routine.each_part(&mut |tokens| {
            for at in tokens.clone() {
                let is_call = file.tokens.get(at).map(|token| token.kind) == Some(Kind::Word)
                    && file.is(at + 1, b'(');
                let name = is_call.then(|| file.name(at)).flatten();
                if let Some(found) = name.and_then(|name| all.routine(index, &name)) {
                    called[found] |= found != index;
                }
            }
        });
    }
    let uncalled = firsts.iter().find(|index| !called[**index]);
    uncalled.or_else(|| firsts.first()).copied()
}
