//! Tools, bases and loads: what the text, a controller's `$config.dat` or the caller says they are.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::ops::Range;

use nalgebra::{Isometry3, Vector3};

use crate::interpreter::expression::{Expression, Node, Operator};
use crate::interpreter::token::TokenFile;
use crate::interpreter::value::{Datum, Step, Value};
use crate::krl::expression::{aggregate_of, place_of};
use crate::krl::lex::{assignment, token_file};
use crate::krl::position::position_of;
use crate::krl::state::{Role, Run, key};
use crate::model::motion::{Frame, FrameUse, ToolLoad};
use crate::model::orientation::OrientationText;
use crate::text::Name;
use crate::text::source::SourceFile;

/// Frames nearer than this are one: what stated numbers lose where they are written down, mm and rad.
const SAME: [f64; 2] = [1e-6, 1e-8];

const NOWHERE: &str = "none of these files states it: give $config.dat, or state it";

/// An element of an array of frames, by its number from 1.
fn element_of(whole: Option<&Datum>, number: u32) -> Datum {
    let Some(whole) = whole else {
        return Datum::unknown(NOWHERE);
    };
    let element = whole.part(&[Step::Index(number as usize - 1)]);
    element.cloned().unwrap_or_else(|| {
        let reason = whole.unknown_reason();
        reason.map_or_else(
            || Datum::unknown(NOWHERE),
            |reason| Datum::unknown(reason.clone()),
        )
    })
}

impl Run<'_, '_> {
    /// A frame that the caller states by its name.
    pub(super) fn stated_frame(&self, name: &str) -> Option<FrameUse> {
        let frame = *self.own.stated.get(&key(name))?;
        Some(FrameUse {
            name: name.to_owned(),
            frame: Frame::Known(frame),
        })
    }

    /// The frame that an expression is: sums of frames are one behind the other.
    pub(super) fn frame(&mut self, expression: &Expression) -> FrameUse {
        let file = self.file();
        let name = key(&file.text(&expression.tokens));
        if let Some((role, index)) = self.numbered_role(expression) {
            return match index {
                Some(number) => self.numbered(role, number),
                None => {
                    let inside = expression.tokens.start + 2..expression.tokens.end - 1;
                    self.computed(role, &file.text(&inside))
                }
            };
        }
        if let Some(stated) = self.stated_frame(&name) {
            return stated;
        }
        match self.part(expression) {
            Ok(frame) => FrameUse {
                name,
                frame: Frame::Known(frame),
            },
            Err(reason) => FrameUse {
                name: self.named_apart(expression, name),
                frame: Frame::Unknown { reason },
            },
        }
    }

    /// `TOOL_DATA[n]` or `BASE_DATA[n]`; number 0 is the flange or the world. What the program gave it in this run counts, else what the
    /// caller states, else what the files state. A value that is not known and is another than that of the first use is another frame.
    pub(super) fn numbered(&mut self, role: Role, number: u32) -> FrameUse {
        let name = format!("{}[{number}]", role.array());
        let known = |name, frame| FrameUse {
            name,
            frame: Frame::Known(frame),
        };
        if number == 0 {
            return known(name, Isometry3::identity());
        }
        let now = self.element(role, number);
        let initial = match self.own.initial.get(&(role, number)) {
            Some(initial) => initial.clone(),
            None => {
                let initial = self.initial_element(role, number);
                self.own.initial.insert((role, number), initial.clone());
                initial
            }
        };
        let is_first = *(self.own.used.entry((role, number))).or_insert_with(|| now.clone()) == now;
        let stated = self.stated_frame(&name);
        match (self.frame_of(&now), stated) {
            (Ok(frame), None) => known(name, frame),
            (Ok(frame), Some(_)) if now != initial => known(name, frame),
            (_, Some(stated)) if is_first => stated,
            (Ok(frame), Some(_)) => known(name, frame),
            (Err(reason), _) => FrameUse {
                name: match is_first {
                    true => name,
                    false => format!("{name} of line {}", self.line()),
                },
                frame: Frame::Unknown { reason },
            },
        }
    }

    /// Says where the program gives an element other numbers than the caller states.
    pub(super) fn compare_with_stated(&mut self, role: Role, number: u32, value: &Datum) {
        let name = format!("{}[{number}]", role.array());
        let (Some(stated), Ok(own)) = (self.own.stated.get(&name), self.frame_of(value)) else {
            return;
        };
        let apart = own.inv_mul(stated);
        let is_same =
            apart.translation.vector.norm() <= SAME[0] && apart.rotation.angle() <= SAME[1];
        if !is_same {
            let at = self.statement.clone();
            self.find(
                &at,
                format!(
                    "`{name}` gets other numbers here than those that are stated for it: those of the program count"
                ),
            );
        }
    }

    /// An element of an array of frames with an index that only the controller knows.
    pub(super) fn computed(&self, role: Role, index: &str) -> FrameUse {
        let name = format!("{}[{}]", role.array(), key(index));
        let reason = "its number is computed while the program runs".to_owned();
        self.stated_frame(&name).unwrap_or(FrameUse {
            name,
            frame: Frame::Unknown { reason },
        })
    }

    /// The value of an element now.
    fn element(&mut self, role: Role, number: u32) -> Datum {
        let name = Name::of(role.array().as_bytes());
        let root = name.and_then(|name| self.root(&name));
        if let Some(root) = root {
            let index = (number as usize).checked_sub(1);
            self.note_use(root, index.map(Step::Index));
        }
        let whole = root.and_then(|root| self.stored(root));
        element_of(whole.as_ref(), number)
    }

    /// The value of an element with which the files begin.
    fn initial_element(&mut self, role: Role, number: u32) -> Datum {
        let name = Name::of(role.array().as_bytes());
        let root = name.and_then(|name| self.root(&name));
        let whole = root
            .and_then(|root| self.datum_of(root))
            .map(|index| self.initial(index));
        element_of(whole.as_ref(), number)
    }

    /// The frame that a value is.
    pub(super) fn frame_of(&self, datum: &Datum) -> Result<Isometry3<f64>, String> {
        if datum.value == Value::Members(Default::default()) {
            return Err(NOWHERE.to_owned());
        }
        let frame = position_of(self.files, datum)?.frame();
        frame.ok_or_else(|| "its numbers are not all stated".to_owned())
    }

    /// The array of frames of an element, and its index where that is known.
    fn numbered_role(&mut self, expression: &Expression) -> Option<(Role, Option<u32>)> {
        let Node::Element(of, indices) = &expression.node else {
            return None;
        };
        let (Node::Word(name), [index]) = (&of.node, indices.as_slice()) else {
            return None;
        };
        let role = Role::of_array(name)?;
        let number = self.value(index).as_number();
        let number = number.filter(|number| (0.0..1e6).contains(number) && number.fract() == 0.0);
        Some((role, number.map(|number| number as u32)))
    }

    fn part(&mut self, expression: &Expression) -> Result<Isometry3<f64>, String> {
        if let Node::Two(Operator::Behind, operands) = &expression.node {
            let [before, behind] = &**operands;
            return Ok(self.part(before)? * self.part(behind)?);
        }
        let frame = match self.numbered_role(expression) {
            Some((role, Some(number))) => self.numbered(role, number).frame,
            Some((_, None)) => {
                return Err("its number is computed while the program runs".to_owned());
            }
            None => {
                let text = key(&self.file().text(&expression.tokens));
                if let Some(stated) = self.own.stated.get(&text) {
                    return Ok(*stated);
                }
                let value = self.value(expression);
                return self.frame_of(&value);
            }
        };
        match frame {
            Frame::Known(frame) => Ok(frame),
            Frame::Unknown { reason } => Err(reason),
        }
    }

    /// The name of a frame that is not known: with its line, where a datum gets several values and each use may be another frame.
    fn named_apart(&self, expression: &Expression, name: String) -> String {
        let file = self.file();
        let names = expression.tokens.clone().filter_map(|at| file.name(at));
        let mut counts = names.map(|name| self.own.assigned.get(&name).copied().unwrap_or(0));
        match counts.any(|count| count > 1) {
            true => format!("{name} of line {}", file.line_of(expression.tokens.start)),
            false => name,
        }
    }
}

// Source: KUKA, KR C2 / KR C3 Expert Programming, KSS 5.x: `TOOL_DATA[n]` and `BASE_DATA[n]` stand in `R1\System\$config.dat`.

/// File name of the controller's data.
pub const KRL_CONFIG: &str = "$config.dat";

/// Largest file of which they are taken.
const MOST_BYTES: usize = 1 << 24;

/// Names that refer to tools and bases by number: arrays, data of inline forms, arguments of BAS; and the home position.
const NAMING: [&[u8]; 7] = [
    b"TOOL_DATA",
    b"BASE_DATA",
    b"TOOL_NO",
    b"BASE_NO",
    b"#TOOL",
    b"#BASE",
    b"XHOME",
];

/// True if files refer to tools or bases by number, or to the controller's home position, and none of them is a `$config.dat`.
///
/// ```
/// use kinetostat_formats::{SourceFile, krl_needs_config};
///
/// let file = |name: &str, text: &str| SourceFile::new(name, text);
/// assert!(krl_needs_config(&[file("a.src", "DEF a()\n$base=base_data[2]\nEND\n")]));
/// assert!(!krl_needs_config(&[file("a.src", "DEF a()\n$BASE={X 0,Y 0,Z 0,A 0,B 0,C 0}\nEND\n")]));
/// let config = "DEFDAT $CONFIG PUBLIC\nBASE_DATA[2]={X 0,Y 0,Z 0,A 0,B 0,C 0}\nENDDAT\n";
/// assert!(!krl_needs_config(&[file("a.src", "$BASE=BASE_DATA[2]\n"), file("R1/System/$Config.dat", config)]));
/// ```
#[must_use]
pub fn krl_needs_config(files: &[SourceFile]) -> bool {
    let is_config = |file: &SourceFile| {
        let name = file.name().rsplit(['/', '\\']).next().unwrap_or_default();
        name.eq_ignore_ascii_case(KRL_CONFIG)
    };
    !files.iter().any(is_config) && files.iter().any(|file| names_frames(file.bytes()))
}

fn names_frames(bytes: &[u8]) -> bool {
    let mut all = bytes.iter().enumerate();
    all.any(|(at, byte)| {
        matches!(byte, b'T' | b't' | b'B' | b'b' | b'#' | b'X' | b'x')
            && NAMING.iter().any(|word| begins(&bytes[at..], word))
    })
}

/// The tools, bases and positions of a `$config.dat` and nothing else of it, in their lines: `TOOL_DATA[n]={...}` and `BASE_DATA[n]={...}`
/// with the number written, and what is declared with its value (`DECL E6AXIS XHOME={...}`, `DECL FDAT FHOME={...}`). None where it holds none, or is larger than 16 MiB.
///
/// ```
/// use kinetostat_formats::{SourceFile, krl_frames_of_config};
///
/// let config = "&ACCESS RV1\nDEFDAT $CONFIG\nINT USER=3\nbase_data[2] = {FRAME: X 10.0,Y 0,Z 0,A 0,B 0,C 0}\nBASE_DATA[I]={X 0}\nENDDAT\n";
/// let frames = krl_frames_of_config(&SourceFile::new("$config.dat", config)).unwrap();
/// let expected = "\nDEFDAT $CONFIG PUBLIC\n\nbase_data[2] = {FRAME: X 10.0,Y 0,Z 0,A 0,B 0,C 0}\n\nENDDAT\n";
/// assert_eq!(frames.bytes(), expected.as_bytes());
/// assert!(krl_frames_of_config(&SourceFile::new("$config.dat", "DEFDAT $CONFIG\nENDDAT\n")).is_none());
/// ```
#[must_use]
pub fn krl_frames_of_config(config: &SourceFile) -> Option<SourceFile> {
    if config.bytes().len() > MOST_BYTES {
        return None;
    }
    let mut kept = Vec::new();
    let mut found = false;
    for line in config.bytes().split(|byte| *byte == b'\n') {
        let line = line.trim_ascii();
        if begins(line, b"DEFDAT") {
            kept.extend_from_slice(b"DEFDAT $CONFIG PUBLIC");
        } else if begins(line, b"ENDDAT") {
            kept.extend_from_slice(b"ENDDAT");
        } else if is_frame(line) || is_declared(line) {
            found = true;
            kept.extend_from_slice(line);
        }
        kept.push(b'\n');
    }
    kept.pop();
    found.then(|| SourceFile::new(config.name(), kept))
}

fn begins(line: &[u8], word: &[u8]) -> bool {
    line.get(..word.len())
        .is_some_and(|start| start.eq_ignore_ascii_case(word))
}

/// Types of positions, and of the data of inline forms that go with them.
const TYPES: [&[u8]; 8] = [
    b"FRAME", b"POS", b"E3POS", b"E6POS", b"AXIS", b"E3AXIS", b"E6AXIS", b"FDAT",
];

/// True if a line declares a position, or the tool and base of one, with its value.
fn is_declared(line: &[u8]) -> bool {
    let mut parts = line.splitn(2, |byte| *byte == b'=');
    let (Some(head), Some(value)) = (parts.next(), parts.next()) else {
        return false;
    };
    let mut words = head.split(u8::is_ascii_whitespace);
    let is_of_type = |word: &[u8]| TYPES.iter().any(|name| word.eq_ignore_ascii_case(name));
    !line.starts_with(b";") && words.any(is_of_type) && value.trim_ascii_start().starts_with(b"{")
}

/// True if a line assigns a numeric frame to an element of TOOL_DATA or BASE_DATA.
fn is_frame(line: &[u8]) -> bool {
    let arrays = [Role::Tool, Role::Base].map(Role::array);
    let Some(array) = arrays.iter().find(|name| begins(line, name.as_bytes())) else {
        return false;
    };
    let parts = || {
        let rest = line[array.len()..].trim_ascii_start().strip_prefix(b"[")?;
        let close = rest.iter().position(|byte| *byte == b']')?;
        let value = rest[close + 1..].trim_ascii_start().strip_prefix(b"=")?;
        Some((rest[..close].trim_ascii(), value.trim_ascii_start()))
    };
    parts().is_some_and(|(number, value)| {
        !number.is_empty()
            && number.iter().all(u8::is_ascii_digit)
            && value.starts_with(b"{")
            && value.contains(&b'}')
    })
}

// The loads of tools that programs and data lists state: `LOAD_DATA[4]={M 5.5,CM {X 0,Y 0,Z 60,A 0,B 0,C 0},J {X 0.1,Y 0.1,Z 0.05}}`.
//
// Source: KUKA System Software 8.x, Operating and Programming Instructions for System Integrators: mass in kg, centre of mass and axes
// of the moments of inertia in axes of the flange, moments about these axes through the centre of mass in kg m^2.

/// Loads by tool number; a tool with conflicting loads is left out, and no load is known if `$LOAD` is not set from the array.
pub(crate) fn tool_loads(files: &[SourceFile]) -> BTreeMap<u32, ToolLoad> {
    let mut found: BTreeMap<u32, Option<ToolLoad>> = BTreeMap::new();
    for (index, source) in files.iter().enumerate() {
        let file = token_file(index, source);
        for line in &file.lines {
            let Some(equals) = assignment(&file, &line.tokens) else {
                continue;
            };
            let value = equals + 1..line.tokens.end;
            let (is_of_array, sets) = match file.name(line.tokens.start) {
                Some(name) if name.is("$LOAD") => {
                    let from = file.name(value.start);
                    (false, from.is_none_or(|from| !from.is("LOAD_DATA")))
                }
                Some(name) => (name.is("LOAD_DATA"), false),
                None => continue,
            };
            if sets {
                return BTreeMap::new();
            }
            if !is_of_array {
                continue;
            }
            let (place, number) = place_of(&file, line.tokens.start, equals);
            let Some(number) = number.filter(|_| place.len() > 1) else {
                return BTreeMap::new();
            };
            let is_whole = place == (line.tokens.start..equals);
            let load = load_of(&file, &value).filter(|_| is_whole);
            match found.entry(number) {
                Entry::Vacant(place) => {
                    place.insert(load);
                }
                Entry::Occupied(mut known) if *known.get() != load => {
                    known.insert(None);
                }
                Entry::Occupied(_) => {}
            }
        }
    }
    let known = found.into_iter();
    known
        .filter_map(|(number, load)| Some((number, load?)))
        .collect()
}

fn load_of(file: &TokenFile<'_>, value: &Range<usize>) -> Option<ToolLoad> {
    let load = aggregate_of(file, value)?;
    let centre = aggregate_of(file, load.member("CM")?)?;
    let moments = aggregate_of(file, load.member("J")?)?;
    let [x, y, z, a, b, c] = ["X", "Y", "Z", "A", "B", "C"].map(|name| centre.number(file, name));
    let [jx, jy, jz] = ["X", "Y", "Z"].map(|name| moments.number(file, name));
    Some(ToolLoad {
        mass_kg: load.number(file, "M")?,
        centre_of_mass_mm: Vector3::new(x?, y?, z?),
        axes_of_moment: OrientationText::Abc.rotation_of(&[a?, b?, c?])?,
        inertia_kg_m2: Vector3::new(jx?, jy?, jz?),
    })
}
