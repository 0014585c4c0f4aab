//! When the M codes of a block act: before its motion or after it, by controller.
//!
//! A block that is divided has a first and a last piece, so every code beside its motion must go to one of them.
//! Controllers do not agree on some codes. If they do, the code goes where it acts. If they do not, it goes to the
//! last piece: a spindle that stops and a coolant that goes off one block late do no harm, one that stops while the
//! tool still cuts does.

/// When a controller executes a code of a block with motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Acts {
    /// Before the motion.
    Before,
    /// While the motion begins.
    During,
    /// When the motion is over.
    After,
    /// The controller wants the code in a block of its own.
    OwnBlock,
    /// The machine's builder decides.
    Builder,
    /// The controller does not have the code.
    Absent,
    /// The source says nothing.
    Unsaid,
}

/// Piece of a divided block in which a code is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Placed {
    /// In the first piece.
    First,
    /// In the last piece.
    Last,
    /// In no piece: the code is refused in a block that feeds.
    Refused,
}

/// One line of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Moment {
    /// Number of the M code.
    pub code: u32,
    /// Function of the code.
    pub meaning: &'static str,
    /// When it acts, in the order of [`CONTROLLERS`].
    pub acts: [Acts; 5],
    /// Piece in which it is written when its block is divided.
    pub placed: Placed,
}

impl Moment {
    /// True if some controllers execute it before the motion and some after it.
    pub fn is_disputed(&self) -> bool {
        self.acts.contains(&Acts::After)
            && (self.acts.contains(&Acts::Before) || self.acts.contains(&Acts::During))
    }
}

/// The controllers of the table, each with the source of its column.
pub const CONTROLLERS: [(&str, &str); 5] = [
    (
        "LinuxCNC",
        "order of the calls that `rs274` of LinuxCNC 2.9 prints for a block with the code and a motion",
    ),
    (
        "grbl",
        "github.com/gnea/grbl, grbl/gcode.c, \"STEP 4: EXECUTE\", steps 4 to 8, 20 and 21",
    ),
    (
        "Sinumerik",
        "SINUMERIK 808D ADVANCED Parameter Manual, MD11110 AUXFU_GROUP_SPEC: defaults 81H, 21H, 41H",
    ),
    (
        "Heidenhain",
        "HEIDENHAIN TNC 155 manual, list of M functions (block beginning, block end)",
    ),
    (
        "i5OS",
        "doc.i5cnc.com, article 491, \"M function group\" (I before, F after the block, separate block)",
    ),
];

const fn moment(code: u32, meaning: &'static str, acts: [Acts; 5], placed: Placed) -> Moment {
    Moment {
        code,
        meaning,
        acts,
        placed,
    }
}

use Acts::{Absent, After, Before, Builder, During, OwnBlock, Unsaid};
use Placed::{First, Last, Refused};

/// Codes of LinuxCNC that other builders use for something else.
const LINUXCNC: [Acts; 5] = [Before, Absent, Builder, Builder, Builder];

/// Every M code that may stand beside a motion, and when it acts. Any other is refused there: only the
/// machine's builder knows whether it acts before or after the motion.
#[rustfmt::skip]
pub const MOMENTS: &[Moment] = &[
    moment(0, "stop", [After, After, After, After, OwnBlock], Last),
    moment(1, "optional stop", [After, After, After, Unsaid, OwnBlock], Last),
    moment(2, "end of program", [After, After, After, After, OwnBlock], Last),
    moment(3, "spindle clockwise", [Before; 5], First),
    moment(4, "spindle counter-clockwise", [Before; 5], First),
    moment(5, "spindle stop", [Before, Before, Before, After, After], Last),
    moment(6, "tool change", [Before, Absent, Builder, After, Builder], Refused),
    moment(7, "mist on", [Before, Before, During, Builder, Unsaid], First),
    moment(8, "coolant on", [Before, Before, During, Before, Unsaid], First),
    moment(9, "coolant off", [Before, Before, During, After, Unsaid], Last),
    moment(13, "spindle clockwise, coolant on", [Absent, Absent, Builder, Before, Unsaid], First),
    moment(14, "spindle counter-clockwise, coolant on", [Absent, Absent, Builder, Before, Unsaid], First),
    moment(19, "spindle to an angle", [Before, Absent, Before, Builder, OwnBlock], Refused),
    moment(30, "end of program", [After, After, After, After, OwnBlock], Last),
    moment(48, "overrides on", LINUXCNC, First),
    moment(49, "overrides off", LINUXCNC, First),
    moment(50, "feed override", LINUXCNC, First),
    moment(51, "spindle override", LINUXCNC, First),
    moment(52, "adaptive feed", LINUXCNC, First),
    moment(53, "feed stop", LINUXCNC, First),
    moment(60, "pallet change and stop", [After, Absent, Builder, Builder, Builder], Last),
    moment(62, "output on with the motion", LINUXCNC, First),
    moment(63, "output off with the motion", LINUXCNC, First),
    moment(64, "output on", LINUXCNC, First),
    moment(65, "output off", LINUXCNC, First),
    moment(66, "wait for an input", LINUXCNC, First),
    moment(67, "analog output with the motion", LINUXCNC, First),
    moment(68, "analog output", LINUXCNC, First),
    moment(82, "absolute extruder words", [Absent, Absent, Builder, Builder, Builder], First),
    moment(83, "relative extruder words", [Absent, Absent, Builder, Builder, Builder], First),
];

/// The line of an M code, in tenths: M5 is 50.
pub(crate) fn moment_of(tenths: u32) -> Option<&'static Moment> {
    MOMENTS
        .iter()
        .find(|moment| tenths.is_multiple_of(10) && moment.code == tenths / 10)
}

/// True if a code is written in the last piece of a divided block. G9 is an exact stop at the block's end.
pub(crate) fn is_written_last(letter: u8, tenths: u32) -> bool {
    match letter {
        b'M' => moment_of(tenths).is_some_and(|moment| moment.placed == Last),
        b'G' => tenths == 90,
        _ => false,
    }
}
