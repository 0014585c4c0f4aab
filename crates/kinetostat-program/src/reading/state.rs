//! What a controller would answer about its state, after the last block.

use crate::reading::interpret::Interpreter;

/// First of the numbered parameters that say where the tool is, in program coordinates and units: X, Y, Z.
const PLACE: u32 = 5420;

impl Interpreter<'_> {
    /// The end of the program was read.
    pub(crate) fn has_ended(&self) -> bool {
        self.ended.is_some()
    }

    /// Where the tool is in program coordinates and units; the reason where that is not known.
    fn coordinate(&self, axis: usize) -> Result<f64, String> {
        let unit = self
            .modes
            .units()
            .map(crate::reading::options::Units::mm_per_unit);
        match (self.known[axis], unit) {
            (true, Some(unit)) => {
                let offset = self.work_offset_mm() + self.offset.active_mm;
                Ok((self.position[axis] - offset[axis]) / unit)
            }
            _ => Err(format!(
                "where the tool is along {} is not known here",
                ["X", "Y", "Z"][axis]
            )),
        }
    }

    /// A numbered parameter that the controller keeps; none for those that programs set.
    pub(crate) fn numbered_state(&self, number: u32) -> Option<Result<f64, String>> {
        match number {
            PLACE..=5422 => Some(self.coordinate((number - PLACE) as usize)),
            5220 => Some(Ok(1.0 + self.modes.work_offset as f64)),
            5161..=5390 | 5400..=5428 => Some(Err(format!(
                "#{number} is kept by the controller, and its value is not known here"
            ))),
            _ => None,
        }
    }

    /// A named parameter of the state; none where there is none of this name.
    pub(crate) fn named_state(&self, name: &str) -> Result<Option<f64>, String> {
        let truth = |holds: bool| Ok(Some(f64::from(u8::from(holds))));
        match name {
            "_x" => self.coordinate(0).map(Some),
            "_y" => self.coordinate(1).map(Some),
            "_z" => self.coordinate(2).map(Some),
            "_metric" => {
                truth(self.modes.units() == Some(crate::reading::options::Units::Millimetres))
            }
            "_imperial" => {
                truth(self.modes.units() == Some(crate::reading::options::Units::Inches))
            }
            "_incremental" => truth(self.modes.incremental),
            "_absolute" => truth(!self.modes.incremental),
            _ => Ok(None),
        }
    }
}
