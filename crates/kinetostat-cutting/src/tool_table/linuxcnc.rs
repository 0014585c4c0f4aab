//! Reads `tool.tbl` of LinuxCNC: `T1 P1 D6.0 Z-50.2 ;comment`, a tool a line.
//!
//! Entries are a letter and a number, between blanks, in any order; T and P are required. X to W are offsets of axes, D the
//! diameter (its sign has no meaning for the size), I J Q angles and orientation of a lathe tool. Lengths are in the units of
//! the machine. A line that begins with `;` is a remark.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{CutError, CutErrorKind, Result, within};

/// Units of the machine, in which `tool.tbl` counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, JsonSchema, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MachineUnit {
    /// `LINEAR_UNITS = mm`.
    #[default]
    Millimetres,
    /// `LINEAR_UNITS = inch`.
    Inches,
}

impl MachineUnit {
    fn mm(self) -> f64 {
        match self {
            Self::Millimetres => 1.0,
            Self::Inches => 25.4,
        }
    }
}

/// A line of `tool.tbl`.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct LinuxCncTool {
    /// Line of the file, from 1.
    pub line: usize,
    /// T.
    pub number: u32,
    /// P, place in the magazine.
    pub pocket: u32,
    /// D without its sign, mm; `None` where it is not given or zero. It may be the wear only, a number near zero.
    pub diameter_mm: Option<f64>,
    /// Z, length offset, mm.
    pub length_mm: Option<f64>,
    /// Comment after the semicolon.
    pub comment: String,
}

/// The tools of a `tool.tbl`.
///
/// ```
/// use kinetostat_cutting::{LinuxCncTable, MachineUnit};
///
/// let text = b"; my tools\nT1 P1 D6.0 Z-50.2 ;6 mm two-flute\nT12 P2\n";
/// let table = LinuxCncTable::read("tool.tbl", text, MachineUnit::Millimetres)?;
/// let tool = table.get(1).unwrap();
/// assert_eq!((tool.diameter_mm, tool.length_mm), (Some(6.0), Some(-50.2)));
/// assert_eq!(tool.comment, "6 mm two-flute");
/// # Ok::<(), kinetostat_cutting::CutError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LinuxCncTable {
    file: String,
    tools: Vec<LinuxCncTool>,
}

impl LinuxCncTable {
    /// Reads the bytes of a file; `file` is its name in errors.
    ///
    /// # Errors
    /// A line that is no tool, numbers out of bounds, a number that two tools have, a file of more than 10 MB or 10 000 tools.
    pub fn read(file: &str, bytes: &[u8], unit: MachineUnit) -> Result<Self> {
        let kind = CutErrorKind::File;
        let whole = |error: CutError| error.at(file, None);
        let size = bytes.len() as f64;
        within(
            kind,
            "bytes of the table of tools",
            size,
            0.0..=MOST_BYTES as f64,
            "",
        )
        .map_err(whole)?;
        let mut tools: Vec<LinuxCncTool> = Vec::new();
        for (index, line) in bytes.split(|byte| *byte == b'\n').enumerate() {
            let line = String::from_utf8_lossy(line);
            let read = tool(&line, index + 1, unit);
            let placed = |error: CutError| error.at(file, Some(index + 1));
            let Some(read) = read.map_err(placed)? else {
                continue;
            };
            within(
                kind,
                "tools",
                tools.len() as f64,
                0.0..=MOST_TOOLS as f64 - 1.0,
                "",
            )
            .map_err(placed)?;
            tools.push(read);
        }
        // Stable: of two tools of one number the earlier line comes first.
        tools.sort_by_key(|tool| tool.number);
        for pair in tools.windows(2) {
            if pair[0].number == pair[1].number {
                let found = format!(
                    "T{}, which is the tool of line {}",
                    pair[1].number, pair[0].line
                );
                let error = CutError::new(
                    kind,
                    "number of the tool",
                    found,
                    "a number of its own for each tool",
                );
                return Err(error.at(file, Some(pair[1].line)));
            }
        }
        Ok(Self {
            file: file.to_owned(),
            tools,
        })
    }

    /// Name of the file.
    #[must_use]
    pub fn file(&self) -> &str {
        &self.file
    }

    /// All tools, by number.
    #[must_use]
    pub fn tools(&self) -> &[LinuxCncTool] {
        &self.tools
    }

    /// The tool of a number.
    #[must_use]
    pub fn get(&self, number: u32) -> Option<&LinuxCncTool> {
        let index = self.tools.binary_search_by_key(&number, |tool| tool.number);
        self.tools.get(index.ok()?)
    }
}

/// A line; `None` for a remark or an empty one.
fn tool(line: &str, number: usize, unit: MachineUnit) -> Result<Option<LinuxCncTool>> {
    let (entries, comment) = line.split_once(';').unwrap_or((line, ""));
    let mut values: [Option<f64>; 26] = [None; 26];
    for entry in entries.split_ascii_whitespace() {
        let (letter, value) = word(entry)?;
        let slot = &mut values[usize::from(letter - b'A')];
        if slot.replace(value).is_some() {
            let found = format!("`{}` twice in one line", char::from(letter));
            return Err(wrong(found, "each letter once"));
        }
    }
    if values.iter().all(Option::is_none) {
        return Ok(None);
    }
    let value = |letter: u8| values[usize::from(letter - b'A')];
    let whole = |letter: u8, name: &str| {
        let Some(value) = value(letter) else {
            return Err(wrong(
                format!("no {}", char::from(letter)),
                &format!("the {name}, as in T1 P1 D6.0 Z-50.2 ;comment"),
            ));
        };
        within(CutErrorKind::File, name, value, 0.0..=1e9, "")?;
        match value.fract() == 0.0 {
            true => Ok(value as u32),
            false => Err(CutError::new(
                CutErrorKind::File,
                name,
                value,
                "a whole number",
            )),
        }
    };
    let length = |letter: u8, name: &str, most: f64| {
        let mm = value(letter).map(|value| value * unit.mm());
        mm.map_or(Ok(None), |mm| {
            within(CutErrorKind::Tool, name, mm, -most..=most, "mm").map(Some)
        })
    };
    Ok(Some(LinuxCncTool {
        line: number,
        number: whole(b'T', "number of the tool")?,
        pocket: whole(b'P', "number of the pocket")?,
        diameter_mm: length(b'D', "diameter D", 1e3)?
            .map(f64::abs)
            .filter(|diameter| *diameter > 0.0),
        length_mm: length(b'Z', "length offset Z", 1e4)?,
        comment: comment.trim().to_owned(),
    }))
}

/// A letter and its number.
fn word(entry: &str) -> Result<(u8, f64)> {
    let known = b"TPXYZABCUVWDIJQ";
    let letter = entry.bytes().next().map(|byte| byte.to_ascii_uppercase());
    let read = letter
        .filter(|letter| known.contains(letter))
        .and_then(|letter| {
            let value: f64 = entry.get(1..)?.parse().ok()?;
            value.is_finite().then_some((letter, value))
        });
    read.ok_or_else(|| {
        let shown: String = entry
            .chars()
            .take(40)
            .flat_map(char::escape_debug)
            .collect();
        wrong(
            format!("`{shown}`"),
            "a letter of T P X Y Z A B C U V W D I J Q and its number, or ; before a remark",
        )
    })
}

fn wrong(found: String, expected: &str) -> CutError {
    CutError::new(CutErrorKind::File, "line of tool.tbl", found, expected)
}

/// Maximum number of bytes of a file.
pub(crate) const MOST_BYTES: usize = 10_000_000;
/// Maximum number of tools of a file.
pub(crate) const MOST_TOOLS: usize = 10_000;
