//! The tools of a robot's program as those of a made one: their numbers stay, and what gets a number is named.

use std::collections::BTreeMap;

use crate::krl::frames::tool_loads as loads_of_krl;
use crate::making::course::before_motion;
use crate::making::events::SourceEvent;
use crate::making::limits::MakeLanguage;
use crate::making::stated::{has_own_zero, is_identity, is_mass, of_tool};
use crate::making::template::{StatedFrame, StatedTool};
use crate::making::{MakeError, MakeFinding};
use crate::model::Language;
use crate::model::motion::{Frame, FrameUse, Motion, ToolLoad};
use crate::model::program::RobotProgram;
use crate::path::of_program::RobotPath;
use crate::path::tools::{number_in, same_frame, tool_numbers};
use crate::rapid::literals::tool_loads;
use crate::text::Name;

/// The tools of a made program.
#[derive(Default)]
pub(crate) struct MadeTools {
    /// Tool of a program with a single one, and before the first change.
    pub tool: StatedTool,
    /// Tools by their numbers in the source, in a program with several.
    pub tools: BTreeMap<u32, StatedTool>,
    /// Findings on tools that got a number or another name.
    pub findings: Vec<MakeFinding>,
    /// Errors of tools, by the line of the first motion.
    pub faults: Vec<MakeError>,
}

/// True if a language has tool change statements of its own, like machines.
fn changes_tools(language: Language) -> bool {
    matches!(
        language,
        Language::Apt | Language::Siemens | Language::Heidenhain
    )
}

/// The tool of a machine before the first change is none.
fn is_none(program: &RobotProgram, tool: &FrameUse) -> bool {
    changes_tools(program.language) && tool.name == "TOOL"
}

/// The tools as the source has them.
pub(crate) fn tools_of_source(
    program: &RobotProgram,
    robot: &RobotPath,
    language: MakeLanguage,
) -> MadeTools {
    let mut made = MadeTools::default();
    let all = &robot.tools;
    let is_one = all.len() == 1;
    let loads = loads_of_source(program, language);
    for (tool, number) in all.iter().zip(tool_numbers(all)) {
        let own = number_in(&tool.name);
        let is_open = is_none(program, tool);
        let number = match (is_one, is_open) {
            (true, _) => own,
            // A controller has some tool always: one that is no other's.
            (false, true) if !language.is_of_an_arm() => None,
            (false, _) => Some(number),
        };
        let mut frame = stated(tool, number, language);
        frame.name = frame.name.filter(|_| !is_open);
        // Another tool than the flange cannot have its number.
        let free = tool_numbers(all).into_iter().max().unwrap_or_default();
        let is_taken = !is_one && number == Some(0);
        frame.number = frame.number.or(is_taken.then(|| free.saturating_add(1)));
        let load = Name::of(tool.name.as_bytes()).and_then(|name| loads.get(&name));
        let stated = StatedTool {
            frame,
            mass_kg: load.map(|load| load.mass_kg),
            centre_of_mass_mm: load.map(|load| load.centre_of_mass_mm),
            axes_of_moment: load.map(|load| load.axes_of_moment),
            inertia_kg_m2: load.map(|load| load.inertia_kg_m2),
        };
        made.faults.extend(faults_at(
            program,
            |motion| same_frame(&motion.tool, tool),
            of_tool(&stated, language),
        ));
        if !is_open && language.is_of_an_arm() {
            let of_this_tool = |motion: &Motion| same_frame(&motion.tool, tool);
            made.faults
                .extend(faults_at(program, of_this_tool, of_no_number(tool)));
        }
        made.findings.extend(renamed(
            program,
            tool,
            own,
            &stated.frame,
            is_open,
            is_one,
            language,
        ));
        match (is_one || is_open, number) {
            (false, Some(number)) => {
                made.tools.insert(number, stated);
            }
            _ => made.tool = stated,
        }
    }
    made
}

/// `$TOOL` itself has no number that another program could name: where it is must be known.
fn of_no_number(tool: &FrameUse) -> Vec<MakeError> {
    match &tool.frame {
        Frame::Unknown { reason } if tool.name.starts_with("$TOOL") => {
            vec![MakeError::of_template(
                format!("where the tool's tip is, is not known: {reason}"),
                "state the tool in the template as [tool]",
            )]
        }
        _ => Vec::new(),
    }
}

/// Faults of what the source itself states, by the line of the first motion that uses it.
pub(crate) fn faults_at(
    program: &RobotProgram,
    uses: impl Fn(&Motion) -> bool,
    faults: Vec<MakeError>,
) -> Vec<MakeError> {
    let first = program.motions.iter().find(|motion| uses(motion));
    let line = first.map(|motion| motion.line);
    let faults = faults.into_iter().map(|fault| MakeError {
        line,
        is_of_template: false,
        ..fault
    });
    faults.collect()
}

/// The loads of the source's tools, where the made program declares them; a controller takes a tool of -1 kg for one without.
fn loads_of_source(program: &RobotProgram, language: MakeLanguage) -> BTreeMap<Name, ToolLoad> {
    let mut loads = match (program.language, language) {
        (Language::Rapid, MakeLanguage::Rapid) => tool_loads(&program.files),
        (Language::Krl, MakeLanguage::Rapid) => {
            let loads = loads_of_krl(&program.files).into_iter();
            let named = loads.filter_map(|(number, load)| {
                let name = format!("TOOL_DATA[{number}]");
                Some((Name::of(name.as_bytes())?, load))
            });
            named.collect()
        }
        _ => return BTreeMap::new(),
    };
    loads.retain(|_, load| is_mass(load.mass_kg));
    loads
}

/// Finding on a tool whose number or name differs from the source.
fn renamed(
    program: &RobotProgram,
    tool: &FrameUse,
    own: Option<u32>,
    frame: &StatedFrame,
    is_open: bool,
    is_one: bool,
    language: MakeLanguage,
) -> Option<MakeFinding> {
    let number = frame.number.unwrap_or(1);
    let written = match language {
        MakeLanguage::Krl if frame.pose.is_some() => return None,
        MakeLanguage::Krl => format!("TOOL_DATA[{number}]"),
        MakeLanguage::Rapid => frame
            .name
            .clone()
            .unwrap_or_else(|| format!("tool{number}")),
        MakeLanguage::FanucLs => format!("UTOOL_NUM={number}"),
        MakeLanguage::Apt if !is_one => format!("LOADTL/{number}"),
        MakeLanguage::Gcode if !is_one => format!("T{number}"),
        MakeLanguage::Csv if !is_one => format!("tool {number}"),
        MakeLanguage::Apt | MakeLanguage::Gcode | MakeLanguage::Csv => return None,
    };
    let same = match language {
        MakeLanguage::Rapid => frame.name.is_some() || own == Some(number),
        _ => own == Some(number),
    };
    let first = program
        .motions
        .iter()
        .find(|motion| same_frame(&motion.tool, tool));
    let line = first.map(|motion| motion.line);
    match (is_open, same) {
        (true, _) if !language.is_of_an_arm() => None,
        (true, _) if is_one => None,
        (true, _) => Some(MakeFinding::of(
            line,
            format!("before the first change of tools the source names none: {written} here"),
        )),
        (false, true) => None,
        (false, false) => {
            let why = match own {
                Some(0) => "has the number 0, which is that of the flange".to_owned(),
                Some(own) => format!("has the number {own}, which another tool has"),
                None => "has no number".to_owned(),
            };
            Some(MakeFinding::of(
                line,
                format!(
                    "the tool `{}` of the source {why}: it is {written} here",
                    tool.name
                ),
            ))
        }
    }
}

/// The number of a tool as the source calls it: `MILL_D10` is not the tool 10.
fn own_number(program: &RobotProgram, tool: &FrameUse) -> Option<u32> {
    number_in(&tool.name).filter(|number| {
        program.language == Language::Apt
            || [format!("T{number}"), format!("TOOL:{number}")].contains(&tool.name)
    })
}

/// Tool changes of a made program: by order keys of the course.
pub(crate) fn changes_of_source(
    program: &RobotProgram,
    robot: &RobotPath,
    of_moves: &[usize],
    events: &[(usize, SourceEvent)],
) -> Vec<(usize, u32)> {
    let all = &robot.tools;
    // One tool is changed to where the source has changes of tools.
    if all.len() < 2 && !changes_tools(program.language) {
        return Vec::new();
    }
    let numbers: Vec<Option<u32>> = match all.len() {
        1 => all.iter().map(|tool| own_number(program, tool)).collect(),
        _ => tool_numbers(all).into_iter().map(Some).collect(),
    };
    let mut changes: Vec<(usize, u32)> = Vec::new();
    let mut last_move = 0;
    for (motion, order) in program.motions.iter().zip(of_moves) {
        let from = std::mem::replace(&mut last_move, *order);
        let index = all.iter().position(|tool| same_frame(tool, &motion.tool));
        let Some(index) = index.filter(|index| !is_none(program, &all[*index])) else {
            continue;
        };
        let Some(number) = numbers[index] else {
            continue;
        };
        if changes.last().is_some_and(|(_, last)| *last == number) {
            continue;
        }
        // The statement that says so, where there is one.
        let end = events.partition_point(|(at, _)| at < order);
        let said = events[..end].iter().rev().take_while(|(at, _)| *at >= from);
        let mut said = said.filter(|(_, event)| event.is_of_tool);
        let at = said.next().map_or(before_motion(*order), |(at, _)| *at);
        changes.push((at, number));
    }
    changes
}

/// A frame of the source by its pose, its number, and its name where the language has names.
pub(crate) fn stated(frame: &FrameUse, number: Option<u32>, language: MakeLanguage) -> StatedFrame {
    let own = frame.name.as_str();
    let is_name = own.starts_with(|c: char| c.is_ascii_alphabetic())
        && own.len() <= 32
        && own.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    // The names of what a controller holds by itself are declared by none.
    let is_system = own.eq_ignore_ascii_case("tool0") || own.eq_ignore_ascii_case("wobj0");
    // Frame 0 belongs to the controller and is never defined by the user, so it keeps its number: $NULLFRAME, wobj0.
    let is_zero = has_own_zero(language) && frame.known().is_some_and(is_identity);
    let is_named = language == MakeLanguage::Rapid && is_name && !is_system;
    StatedFrame {
        number: number
            .or(number_in(own))
            .filter(|number| *number <= 255 && (*number > 0 || !has_own_zero(language) || is_zero))
            .or(is_zero.then_some(0)),
        name: is_named.then(|| own.to_owned()),
        pose: frame.known().copied(),
        object_frame: None,
    }
}
