//! Reads our table of tools from TOML.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use serde_spanned::Spanned;

use crate::error::{CutError, CutErrorKind, Result, within};
use crate::source::{Source, Subject};
use crate::tool::{RunOut, Shape, Tool};
use crate::tool_table::linuxcnc::{LinuxCncTable, LinuxCncTool, MOST_BYTES, MOST_TOOLS};
use crate::tool_table::written::{File, ShapeName, ToolEntry, WrittenTool};

/// Shares of the diameter: a D of `tool.tbl` up to this far from it is the measured diameter, one up to this far from zero
/// the wear (LinuxCNC allows both).
const SAME_DIAMETER: f64 = 0.1;

const TOOLS: Subject = Subject {
    entry: "tool",
    whole: "table of tools",
    form: "[[tool]] with number, shape, diameter_mm, teeth, each on a line of its own",
};

impl Source<'_> {
    fn shape(&self, entry: &WrittenTool) -> Result<Shape> {
        let name = *entry.shape.get_ref();
        let only = |key: &str, value: &Option<Spanned<f64>>, of: ShapeName, shape: &str| {
            let byte = match (value, name == of) {
                (Some(_), true) | (None, false) => return Ok(0.0),
                (Some(value), false) => value.span().start,
                (None, true) => entry.shape.span().start,
            };
            let (found, expected) = match value {
                None => (
                    "nothing".to_owned(),
                    format!("a number: shape \"{shape}\" needs it"),
                ),
                Some(value) => (
                    format!("{}", value.get_ref()),
                    format!("nothing: only shape \"{shape}\" has it"),
                ),
            };
            Err(self.error(byte, key, found, expected))
        };
        only(
            "corner_radius_mm",
            &entry.corner_radius_mm,
            ShapeName::Bull,
            "bull",
        )?;
        only(
            "lead_angle_deg",
            &entry.lead_angle_deg,
            ShapeName::Face,
            "face",
        )?;
        let value = |given: &Option<Spanned<f64>>| given.as_ref().map_or(0.0, |v| *v.get_ref());
        Ok(match name {
            ShapeName::Flat => Shape::Flat,
            ShapeName::Ball => Shape::Ball,
            ShapeName::Bull => Shape::Bull {
                corner_radius_mm: value(&entry.corner_radius_mm),
            },
            ShapeName::Face => Shape::Face {
                lead_angle: value(&entry.lead_angle_deg).to_radians(),
            },
        })
    }

    /// The diameter of the entry, or that of `tool.tbl`; one of each must be of the same tool.
    fn diameter(
        &self,
        entry: &WrittenTool,
        at: usize,
        known: Option<(&str, &LinuxCncTool)>,
    ) -> Result<f64> {
        let given = self.number(
            "diameter_mm",
            entry.diameter_mm.as_ref(),
            0.01..=1000.0,
            "mm",
        )?;
        let of_machine = known.and_then(|(file, tool)| Some((file, tool, tool.diameter_mm?)));
        match (given, of_machine) {
            (Some(given), None) => Ok(given),
            (None, Some((_, _, measured))) if measured > 0.0 => Ok(measured),
            (Some(given), Some((file, tool, measured))) => {
                let wear = measured <= SAME_DIAMETER * given;
                match wear || (measured - given).abs() <= SAME_DIAMETER * given {
                    true => Ok(given),
                    false => {
                        let byte = entry
                            .diameter_mm
                            .as_ref()
                            .map_or(at, |value| value.span().start);
                        let expected = format!(
                            "the {measured} mm of tool {} in {file}:{}, or the other tool under this number",
                            tool.number, tool.line
                        );
                        Err(self.error(byte, "diameter_mm", format!("{given} mm"), expected))
                    }
                }
            }
            (None, _) => {
                let expected = "a line `diameter_mm = ...` under this [[tool]]".to_owned();
                Err(self.error(at, "tool", "no `diameter_mm`".to_owned(), expected))
            }
        }
    }

    fn edges(&self, entry: &WrittenTool, at: usize, diameter_mm: f64) -> Result<Tool> {
        let shape = self.shape(entry)?;
        // The tool knows no lines: its error is put where the quantity stands.
        let start = |value: &Option<Spanned<f64>>| value.as_ref().map_or(at, |v| v.span().start);
        let placed = |error: CutError| {
            let byte = match error.quantity.as_str() {
                "teeth" => entry.teeth.span().start,
                "diameter" => start(&entry.diameter_mm),
                "corner radius" => start(&entry.corner_radius_mm),
                "lead angle" => start(&entry.lead_angle_deg),
                "helix" => start(&entry.helix_deg),
                "run-out" => start(&entry.run_out_um),
                _ => at,
            };
            error.at(self.file, Some(self.line(byte)))
        };
        let degrees = |key: &str, value: &Option<Spanned<f64>>| {
            let value = self.number(key, value.as_ref(), -360.0..=360.0, "deg")?;
            Ok(value.unwrap_or_default().to_radians())
        };
        let um = self.number("run_out_um", entry.run_out_um.as_ref(), 0.0..=1000.0, "um")?;
        let run_out = RunOut {
            offset_mm: 1e-3 * um.unwrap_or_default(),
            angle: degrees("run_out_angle_deg", &entry.run_out_angle_deg)?,
        };
        let helix = degrees("helix_deg", &entry.helix_deg)?;
        let teeth = usize::try_from(*entry.teeth.get_ref()).unwrap_or(usize::MAX);
        Tool::new(shape, diameter_mm, teeth)
            .and_then(|tool| tool.with_helix(helix))
            .and_then(|tool| tool.with_run_out(run_out))
            .map_err(placed)
    }

    pub(crate) fn entry(
        &self,
        number: u32,
        spanned: Spanned<WrittenTool>,
        known: Option<(&str, &LinuxCncTool)>,
    ) -> Result<ToolEntry> {
        let at = spanned.span().start;
        let entry = spanned.into_inner();
        let machine = known.map(|(_, tool)| tool);
        let diameter_mm = self.diameter(&entry, at, known)?;
        let tool = self.edges(&entry, at, diameter_mm)?;
        let stick_out_mm = self.number(
            "stick_out_mm",
            entry.stick_out_mm.as_ref(),
            0.1..=2000.0,
            "mm",
        )?;
        let flute_length_mm = self.number(
            "flute_length_mm",
            entry.flute_length_mm.as_ref(),
            0.01..=2000.0,
            "mm",
        )?;
        if let (Some(flutes), Some(out), Some(written)) =
            (flute_length_mm, stick_out_mm, &entry.flute_length_mm)
            && flutes > out
        {
            let expected =
                format!("at most the {out} mm of stick_out_mm: edges in the holder cut nothing");
            let byte = written.span().start;
            return Err(self.error(byte, "flute_length_mm", format!("{flutes} mm"), expected));
        }
        let given = self.number("length_mm", entry.length_mm.as_ref(), -1e4..=1e4, "mm")?;
        Ok(ToolEntry {
            number,
            name: match (entry.name.is_empty(), machine) {
                (true, Some(tool)) => tool.comment.clone(),
                _ => entry.name,
            },
            tool,
            stick_out_mm,
            flute_length_mm,
            rake_deg: self.number("rake_deg", entry.rake_deg.as_ref(), -30.0..=40.0, "deg")?,
            max_chip_mm: self.number(
                "max_chip_mm",
                entry.max_chip_mm.as_ref(),
                1e-4..=10.0,
                "mm",
            )?,
            length_mm: given.or(machine.and_then(|tool| tool.length_mm)),
        })
    }
}

impl ToolEntry {
    /// A tool that stands in a text among other things, under a number that is said elsewhere.
    ///
    /// ```
    /// use kinetostat_cutting::{ToolEntry, WrittenTool};
    /// use serde_spanned::Spanned;
    ///
    /// let text = "shape = \"flat\"\ndiameter_mm = 6\nteeth = 2\n";
    /// let written: Spanned<WrittenTool> = toml::from_str(text)?;
    /// let entry = ToolEntry::written("job.toml", text, 3, &written)?;
    /// assert_eq!((entry.number, entry.tool.teeth()), (3, 2));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As a table of tools, with the line in the text.
    pub fn written(
        file: &str,
        text: &str,
        number: u32,
        written: &Spanned<WrittenTool>,
    ) -> Result<Self> {
        Source { file, text }.entry(number, written.clone(), None)
    }
}

/// True if the first line that is not empty is one of a `tool.tbl`.
fn is_of_linuxcnc(text: &str) -> bool {
    let mut lines = text.lines().map(str::trim);
    let first = lines.find(|line| !line.is_empty() && !line.starts_with([';', '#']));
    let mut letters = first.into_iter().flat_map(str::chars);
    letters.next() == Some('T') && letters.next().is_some_and(|digit| digit.is_ascii_digit())
}

/// All tools of a text, by number.
pub(crate) fn read(
    file: &str,
    text: &str,
    machine: Option<&LinuxCncTable>,
) -> Result<BTreeMap<u32, ToolEntry>> {
    let source = Source { file, text };
    let most = |quantity: &str, count: usize, most: usize| {
        let bounds = 0.0..=most as f64;
        within(CutErrorKind::File, quantity, count as f64, bounds, "")
            .map_err(|error| error.at(file, None))
    };
    most("bytes of the table of tools", text.len(), MOST_BYTES)?;
    let read: File = toml::from_str(text).map_err(|error| match is_of_linuxcnc(text) {
        true => source.error(
            0,
            "table of tools",
            "a line of a `tool.tbl` of LinuxCNC (T1 P1 D6 ...)".to_owned(),
            "a table in TOML with [[tool]]; `tool.tbl` is named beside it (tool_tbl under [cutters]), for it says nothing of teeth".to_owned(),
        ),
        false => source.toml_fault(&error, &TOOLS),
    })?;
    most("tools", read.tool.len(), MOST_TOOLS)?;
    let mut lines: BTreeMap<u32, usize> = BTreeMap::new();
    let mut entries = BTreeMap::new();
    for spanned in read.tool {
        let Some(written) = &spanned.get_ref().number else {
            let expected = "a line `number = ...` under this [[tool]]".to_owned();
            return Err(source.error(
                spanned.span().start,
                "tool",
                "no `number`".to_owned(),
                expected,
            ));
        };
        let (number, byte) = (*written.get_ref(), written.span().start);
        if let Some(line) = lines.insert(number, source.line(byte)) {
            let found = format!("{number}, which is the tool of line {line}");
            let expected = "a number of its own for each tool".to_owned();
            return Err(source.error(byte, "number", found, expected));
        }
        let known = machine.and_then(|table| Some((table.file(), table.get(number)?)));
        entries.insert(number, source.entry(number, spanned, known)?);
    }
    Ok(entries)
}

impl Source<'_> {
    /// A number of a key within bounds; the error names the key and its line.
    pub(crate) fn number(
        &self,
        key: &str,
        value: Option<&Spanned<f64>>,
        bounds: RangeInclusive<f64>,
        unit: &str,
    ) -> Result<Option<f64>> {
        let Some(value) = value else { return Ok(None) };
        within(CutErrorKind::Tool, key, *value.get_ref(), bounds, unit)
            .map(Some)
            .map_err(self.placed(value))
    }
}
