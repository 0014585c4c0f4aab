//! The tools of a shop, by number.

use std::collections::BTreeMap;

use crate::error::{CutError, CutErrorKind, Result};
use crate::tool_table::linuxcnc::LinuxCncTable;
use crate::tool_table::toml_file;
use crate::tool_table::written::ToolEntry;

/// Tools by number.
#[derive(Clone, Debug, PartialEq)]
pub struct ToolTable {
    file: String,
    entries: BTreeMap<u32, ToolEntry>,
    machine: Option<LinuxCncTable>,
}

impl ToolTable {
    /// Reads a table of tools; `file` is its name in errors. Keys of a `[[tool]]`: `number`, `name`, `shape` (flat, ball, bull,
    /// face), `diameter_mm`, `teeth`, `helix_deg`, `corner_radius_mm` (bull), `lead_angle_deg` (face), `stick_out_mm`,
    /// `flute_length_mm`, `run_out_um`, `run_out_angle_deg`, `rake_deg`, `max_chip_mm`, `length_mm`; number, shape, diameter
    /// and teeth are required.
    ///
    /// ```
    /// use kinetostat_cutting::ToolTable;
    ///
    /// let text = r#"
    /// [[tool]]
    /// number = 3
    /// shape = "flat"
    /// diameter_mm = 6
    /// teeth = 2
    /// max_chip_mm = 0.08
    /// "#;
    /// let table = ToolTable::read("tools.toml", text)?;
    /// assert_eq!(table.tool(3)?.tool.radius_mm(), 3.0);
    /// let error = ToolTable::read("tools.toml", &text.replace("teeth", "teth")).unwrap_err();
    /// assert_eq!(error.to_string(), "tools.toml:6: key of a tool: `teth` is not known here; did you mean `teeth`?");
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// What is no such table, an unknown key, a number out of bounds, edges longer than the stick-out, a number given twice, a
    /// file of more than 10 MB or 10 000 tools; each with file and line.
    pub fn read(file: &str, text: &str) -> Result<Self> {
        Ok(Self {
            file: file.to_owned(),
            entries: toml_file::read(file, text, None)?,
            machine: None,
        })
    }

    /// Reads the table beside a `tool.tbl`, which gives each tool of the same number its length offset, diameter and
    /// name where this table leaves them out.
    ///
    /// A D of `tool.tbl` near zero is the wear and is not added to the diameter.
    ///
    /// ```
    /// use kinetostat_cutting::{LinuxCncTable, MachineUnit, ToolTable};
    ///
    /// let machine = b"T3 P1 D6.01 Z-50.2 ;two-flute\nT4 P2 D10 ;drill\n";
    /// let machine = LinuxCncTable::read("tool.tbl", machine, MachineUnit::Millimetres)?;
    /// let ours = "[[tool]]\nnumber = 3\nshape = 'flat'\nteeth = 2\n";
    /// let table = ToolTable::completing("tools.toml", ours, machine)?;
    /// assert_eq!(table.tool(3)?.tool.diameter_mm(), 6.01);
    /// assert_eq!(table.tool(3)?.length_mm, Some(-50.2));
    /// assert_eq!(
    ///     table.tool(4).unwrap_err().to_string(),
    ///     "tool.tbl:2: tool 4 (drill): no shape, no teeth; expected [[tool]] with number = 4, shape, teeth in tools.toml"
    /// );
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`ToolTable::read`], and a diameter that is not that of `tool.tbl` within a tenth.
    pub fn completing(file: &str, text: &str, machine: LinuxCncTable) -> Result<Self> {
        Ok(Self {
            file: file.to_owned(),
            entries: toml_file::read(file, text, Some(&machine))?,
            machine: Some(machine),
        })
    }

    /// All tools that are complete, by number.
    pub fn entries(&self) -> impl Iterator<Item = &ToolEntry> {
        self.entries.values()
    }

    /// The tool of a number.
    ///
    /// # Errors
    /// A tool that is not in the table; one that is in `tool.tbl` alone, with what is missing.
    pub fn tool(&self, number: u32) -> Result<&ToolEntry> {
        self.entries
            .get(&number)
            .ok_or_else(|| self.missing(number))
    }

    fn missing(&self, number: u32) -> CutError {
        let machine = self.machine.as_ref();
        let Some((table, tool)) = machine.and_then(|table| Some((table, table.get(number)?)))
        else {
            let expected = format!("[[tool]] with number = {number}, shape, diameter_mm, teeth");
            return CutError::new(
                CutErrorKind::Tool,
                format!("tool {number}"),
                "not in the table",
                expected,
            )
            .at(&self.file, None);
        };
        let comment = match tool.comment.is_empty() {
            true => String::new(),
            false => format!(" ({})", tool.comment),
        };
        let (diameter, also) = match tool.diameter_mm {
            Some(_) => ("", ""),
            None => ("no diameter, ", "diameter_mm, "),
        };
        CutError::new(
            CutErrorKind::Tool,
            format!("tool {number}{comment}"),
            format!("{diameter}no shape, no teeth"),
            format!(
                "[[tool]] with number = {number}, {also}shape, teeth in {}",
                self.file
            ),
        )
        .at(table.file(), Some(tool.line))
    }
}
