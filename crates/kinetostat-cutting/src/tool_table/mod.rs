//! Tables of tools: ours in TOML, and `tool.tbl` of LinuxCNC.
//!
//! Takes the text of the files, gives a [`ToolEntry`] for each number; a mistake is named with file, line and key. A
//! `tool.tbl` has no teeth and no shape: an entry of ours with the same number completes it, and a tool that lacks one is
//! named when it is asked for. Source of the format: LinuxCNC, `docs/src/gcode/tool-compensation.adoc`, "Tool Table Format".

mod linuxcnc;
mod table;
mod toml_file;
mod written;

pub use linuxcnc::{LinuxCncTable, LinuxCncTool, MachineUnit};
pub use table::ToolTable;
pub use written::{ToolEntry, WrittenTool};
