//! Checks that a template states each tool of a program, with unique names or numbers and one tip for the cutting edges in use.

use std::collections::{BTreeMap, BTreeSet};

use kinetostat_program::{Knowledge, MoveKind, Path};
use nalgebra::Isometry3;

use crate::making::course::Course;
use crate::making::events::EventKind;
use crate::making::limits::MakeLanguage;
use crate::making::names::name_of_tool;
use crate::making::template::{StatedTool, Template};
use crate::making::{MakeError, MakeFinding};
use crate::model::Language;

/// Errors and assumptions on the tools of a program and a template.
#[derive(Debug, Default)]
pub(crate) struct Told {
    pub faults: Vec<MakeError>,
    pub findings: Vec<MakeFinding>,
}

/// Tool usage of a program for a robot controller, which must know the TCPs.
pub(crate) fn told(
    path: &Path,
    course: &Course,
    template: &Template,
    language: MakeLanguage,
) -> Told {
    let mut told = Told::default();
    if !language.is_of_an_arm() {
        return told;
    }
    let used = Used::of(path, course);
    // One tool that [[tools]] does not have is that of [tool].
    let is_single = used.numbered.len() + usize::from(used.first_unnamed.is_some()) < 2;
    let is_told = template.tool != StatedTool::default() || template.tools.is_empty();
    for (number, line) in &used.numbered {
        let is_known = template.tools.contains_key(number);
        let is_only_change = template.tools.is_empty() && used.numbered.len() < 2;
        if is_known || is_only_change || (is_single && is_told) {
            continue;
        }
        told.faults.push(MakeError::at(
            *line,
            format!("the program takes the tool {number}, one of several, and where its tip is, is not stated"),
            "state each of them in the template under [[tools]] (with a [tool] in the template its tools stand for those of the source), or write one program for each tool",
        ));
    }
    if let Some(line) = used.first_unnamed {
        told.unnamed(line, &used, template, is_told);
    }
    told.faults.extend(alike(&used, template, language));
    told
}

/// The tools of the moves that are written.
#[derive(Default)]
struct Used {
    /// Numbered tools, with the line of their first use.
    numbered: BTreeMap<u32, usize>,
    /// Line of the first move before the program takes any.
    first_unnamed: Option<usize>,
    /// A tool without a number cuts.
    cuts_unnamed: bool,
}

impl Used {
    fn of(path: &Path, course: &Course) -> Self {
        let mut used = Self::default();
        let changes: BTreeMap<u32, usize> = (path.tool_changes.iter().rev())
            .map(|change| (change.number, change.line))
            .collect();
        for (index, motion) in path.moves.iter().enumerate() {
            if motion.known == Knowledge::Nothing {
                continue;
            }
            match course.tool_at(course.of_move(index, motion.line)) {
                Some(number) => {
                    let line = changes.get(&number).copied().unwrap_or(motion.line);
                    used.numbered.entry(number).or_insert(line);
                }
                None => {
                    used.first_unnamed.get_or_insert(motion.line);
                    used.cuts_unnamed |= motion.kind == MoveKind::Feed;
                }
            }
        }
        used
    }
}

impl Told {
    /// Moves before the program takes a tool.
    fn unnamed(&mut self, line: usize, used: &Used, template: &Template, is_told: bool) {
        if !is_told {
            self.faults.push(MakeError::at(
                line,
                "the program has taken no tool here, and the template tells those under [[tools]] alone",
                "state the one with which the program begins as [tool] in the template",
            ));
            return;
        }
        let change = used.numbered.iter().min_by_key(|(_, line)| **line);
        let Some((number, line)) = change.filter(|_| template.tools.is_empty()) else {
            return;
        };
        if used.cuts_unnamed {
            self.faults.push(MakeError::at(
                *line,
                format!("the program takes the tool {number} after moves at feed with the one before, and the template tells one tool"),
                format!("state the other one in the template under [[tools]] with in_program = {number} ([tool] is the one before), or write one program for each tool"),
            ));
        } else {
            self.findings.push(MakeFinding::of(
                *line,
                format!("the program takes the tool {number} here after rapids with the one before: all moves go with the tip of [tool]"),
            ));
        }
    }
}

/// Tools of other tips that would be one on the controller.
fn alike(used: &Used, template: &Template, language: MakeLanguage) -> Vec<MakeError> {
    let mut known: BTreeMap<String, (Option<Isometry3<f64>>, String)> = BTreeMap::new();
    let mut faults = Vec::new();
    let numbered = template
        .tools
        .iter()
        .map(|(number, tool)| (Some(*number), tool));
    let is_used = used.first_unnamed.is_some()
        || (used.numbered.keys()).any(|number| !template.tools.contains_key(number));
    let own = is_used.then_some((None, &template.tool));
    let mut seen: BTreeSet<String> = BTreeSet::new();
    for (in_program, tool) in own.into_iter().chain(numbered) {
        let number = tool.frame.number.or(in_program).unwrap_or(1);
        let name = match language {
            MakeLanguage::Rapid => name_of_tool(in_program, tool),
            MakeLanguage::FanucLs => format!("UTOOL_NUM={number}"),
            // KRL writes the poses themselves.
            _ if tool.frame.pose.is_some() => continue,
            _ => format!("TOOL_DATA[{number}]"),
        };
        let place = match in_program {
            Some(number) => format!("in_program = {number} under [[tools]]"),
            None => "[tool]".to_owned(),
        };
        let key = name.to_ascii_uppercase();
        let Some((pose, other)) = known.get(&key) else {
            known.insert(key, (tool.frame.pose, place));
            continue;
        };
        // Without poses it is left to the controller whether two are one.
        if *pose != tool.frame.pose && seen.insert(key) {
            faults.push(MakeError::of_template(
                format!("{other} and {place} are both {name} on the controller, and their poses are not the same"),
                "give each of them a number (RAPID: or a name) of its own",
            ));
        }
    }
    faults
}

// Cutting edges of tools of SINUMERIK (`D2`): each has a length of its own, and a template tells one tip for each tool.
//
// Source: Siemens, SINUMERIK 840D sl, Fundamentals, "Tool offset call (D)": D1 counts behind a change of tools where none is programmed.

/// The edge of which the tip counts where none is programmed.
const USUAL: u64 = 1;

/// Moves with another edge of a tool than those before, once each.
pub(crate) fn other_edges(path: &Path, course: &Course, language: MakeLanguage) -> Vec<MakeError> {
    if course.language != Some(Language::Siemens) || !language.is_of_an_arm() {
        return Vec::new();
    }
    let mut edge = (USUAL, None);
    let mut of_tools: BTreeMap<Option<u32>, u64> = BTreeMap::new();
    let mut faults: Vec<MakeError> = Vec::new();
    let mut events = course.events.iter().peekable();
    for (index, motion) in path.moves.iter().enumerate() {
        let order = course.of_move(index, motion.line);
        while let Some((_, event)) = events.next_if(|(at, _)| *at < order) {
            if event.kind == EventKind::Comment {
                continue;
            }
            if let Some(stated) = edge_of(&event.text) {
                edge = (stated, Some(event.line));
            }
        }
        if motion.known == Knowledge::Nothing {
            continue;
        }
        let own = *of_tools.entry(course.tool_at(order)).or_insert(edge.0);
        let line = edge.1.unwrap_or(motion.line);
        if own != edge.0 && faults.iter().all(|fault| fault.line != Some(line)) {
            faults.push(MakeError::at(
                line,
                format!("D{} is another edge of the tool than D{own} before, with a tip of its own, and a template tells one tip for each tool", edge.0),
                "write one program for each edge, or leave the word out where the tip is the same",
            ));
        }
    }
    faults
}

/// The edge that words of a block name: that of D, or the usual one of another tool.
fn edge_of(text: &str) -> Option<u64> {
    let code = text.split(';').next().unwrap_or_default();
    let words: Vec<&str> = code
        .split(|c: char| c.is_whitespace() || c == '(')
        .collect();
    let number = |word: &&str| {
        let digits = word.strip_prefix(['D', 'd'])?;
        digits.trim_start_matches('=').parse().ok()
    };
    let changes = |word: &&str| {
        ["M6", "M06"]
            .iter()
            .any(|own| word.eq_ignore_ascii_case(own))
    };
    (words.iter().find_map(number)).or(words.iter().any(changes).then_some(USUAL))
}
