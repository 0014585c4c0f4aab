//! The table of G and M codes: what each is to the interpreter.

/// Treatment of a code by the interpreter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Treatment {
    /// The meaning of the code is followed.
    Understood,
    /// The code neither moves the tool nor changes its path; it is carried byte for byte.
    Carried,
    /// The code can move the tool or change its path in a way that is not followed.
    Refused {
        /// Reason of the refusal.
        reason: &'static str,
        /// Remedy.
        remedy: &'static str,
    },
}

/// One line of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Code {
    /// `G` or `M`.
    pub letter: char,
    /// The codes, each in tenths: G38.2 is 382. Exactly these and none between them.
    pub tenths: &'static [u32],
    /// Meaning on the controllers that have it.
    pub meaning: &'static str,
    /// Treatment by the interpreter.
    pub treatment: Treatment,
}

use Treatment::{Carried, Understood};

const fn g(tenths: &'static [u32], meaning: &'static str, treatment: Treatment) -> Code {
    Code {
        letter: 'G',
        tenths,
        meaning,
        treatment,
    }
}

const fn m(tenths: &'static [u32], meaning: &'static str, treatment: Treatment) -> Code {
    Code {
        letter: 'M',
        tenths,
        meaning,
        treatment,
    }
}

const fn refused(reason: &'static str, remedy: &'static str) -> Treatment {
    Treatment::Refused { reason, remedy }
}

const WRITE_MOVES: &str = "let the CAM system write the motion as G0 and G1 to G3 blocks";
const EXPAND: &str = "have it written as moves (--expand, or a table [expand] in the job file; --dialect fanuc or linuxcnc where controllers disagree), or let the CAM system write G0 and G1 to G3 blocks";
const OWN_PROGRAM: &str = "take it out of the program and run it by hand or from another program";

/// Every code that is known, one by one: a code between two of them (G2.1, G90.2) is unknown.
///
/// A G code outside the table is refused. An M code outside it and outside [`crate::MOMENTS`] is carried
/// byte for byte where it stands in a block without motion, and refused beside a motion.
pub const CODES: &[Code] = &[
    g(&[0], "rapid motion", Understood),
    g(&[10], "straight feed motion", Understood),
    g(&[20, 30], "circular or helical feed motion", Understood),
    g(&[40], "dwell", Carried),
    g(
        &[50, 51, 52, 53],
        "spline; G5 P0, P2, P10000 and G5.1 Q without a place set the look-ahead (Fanuc) and are carried",
        refused(
            "splines, and cycles in the control's memory, are not followed",
            WRITE_MOVES,
        ),
    ),
    g(
        &[70],
        "lathe diameter mode",
        refused("X would count as a diameter", "write X as a radius (G8)"),
    ),
    g(&[80], "lathe radius mode", Carried),
    g(&[90], "exact stop in this block", Carried),
    g(&[100], "set offsets or tool data", Understood),
    g(
        &[110],
        "setting of data off",
        refused(
            "it changes offsets that the path depends on",
            "set the offsets at the machine and give work offsets (--work-offset, or work_offset_mm under [reading] in the job file)",
        ),
    ),
    g(&[1030], "blocks read ahead (Haas)", Carried),
    g(
        &[120, 130],
        "pocket cycles",
        refused("a cycle's motion is the controller's own", WRITE_MOVES),
    ),
    g(&[150], "polar coordinates off", Carried),
    g(
        &[160],
        "polar coordinates on",
        refused(
            "X and Y would be radius and angle",
            "write Cartesian coordinates",
        ),
    ),
    g(&[170], "plane XY", Understood),
    g(&[180], "plane ZX", Understood),
    g(&[190], "plane YZ", Understood),
    g(
        &[171, 181, 191],
        "planes of U V W",
        refused("arcs of the axes U V W are not followed", WRITE_MOVES),
    ),
    g(&[200, 210], "inches, millimetres", Understood),
    g(&[280, 300], "to a reference point", Understood),
    g(
        &[281, 282, 301],
        "homing, setting of reference points",
        refused("some controllers move, some store the place", OWN_PROGRAM),
    ),
    g(
        &[290],
        "probing of the bed",
        refused("it moves by what a probe finds", OWN_PROGRAM),
    ),
    g(
        &[310],
        "skip or probe",
        refused("it moves until a signal comes", OWN_PROGRAM),
    ),
    g(
        &[330, 331],
        "threading, rigid tapping",
        refused(
            "motion is tied to the spindle",
            "leave threads to a program that is not compensated",
        ),
    ),
    g(
        &[382, 383, 384, 385],
        "probing",
        refused("it moves until a probe answers", OWN_PROGRAM),
    ),
    g(&[400], "cutter radius compensation off", Understood),
    g(
        &[410, 411, 420, 421],
        "cutter radius compensation on",
        refused(
            "the controller offsets the path by a radius that is not in the program",
            "have it computed (--expand and --tool-diameter-mm, or tables in the job file: [expand]), or let the CAM system write the centre line of the tool (compensation in computer), then G40",
        ),
    ),
    g(&[430], "tool length offset on", Understood),
    g(&[431, 432], "tool length offset by words", Understood),
    g(
        &[434],
        "tool length offset with tool centre point control: with rotary axes in the model",
        Understood,
    ),
    g(
        &[435],
        "the same, with directions of the tool (I, J, K) in place of angles: with rotary axes in the model",
        Understood,
    ),
    g(
        &[433, 437, 440],
        "tool length offset with tool point control",
        refused(
            "it changes where the tool point goes",
            "use G43 H with a Z word, or set the length at the machine",
        ),
    ),
    g(&[490], "tool length offset off", Understood),
    g(
        &[500, 501, 510, 511],
        "scaling, mirroring",
        refused(
            "coordinates would be scaled",
            "write coordinates in full size, or have them written so (--expand; LinuxCNC has no such word)",
        ),
    ),
    g(
        &[520],
        "local offset",
        refused(
            "controllers disagree whether it adds to G92 or replaces it",
            "use G54 to G59 and give their offsets (--work-offset, or work_offset_mm under [reading] in the job file)",
        ),
    ),
    g(&[530], "machine coordinates in this block", Understood),
    g(
        &[540, 541, 550, 560, 570, 580, 590, 591, 592, 593, 1540],
        "work coordinate systems (G54.1 P1 to P300, G154 P1 to P99: additional ones of Fanuc and Haas)",
        Understood,
    ),
    g(&[1870], "how exactly the path is followed (Haas)", Carried),
    g(
        &[600],
        "approach from one side",
        refused("it adds a motion of the controller's own", "remove it"),
    ),
    g(&[610, 611], "exact path, exact stop", Carried),
    g(&[640], "path blending", Carried),
    g(
        &[680, 681, 682, 683, 684],
        "rotation of coordinates",
        refused(
            "coordinates would be turned",
            "let the CAM system write turned coordinates, or have them written so (--expand; LinuxCNC has no such word)",
        ),
    ),
    g(&[690], "rotation of coordinates off", Carried),
    g(
        &[700, 710],
        "lathe cycles",
        refused(
            "a cycle's motion is the controller's own",
            "where another control has it for inches or millimetres write G20 or G21 (a program of SINUMERIK is read as a file .mpf), or let the CAM system write the motion as G0 and G1 to G3 blocks",
        ),
    ),
    g(
        &[711, 712, 717, 720, 721, 722],
        "lathe cycles",
        refused("a cycle's motion is the controller's own", WRITE_MOVES),
    ),
    g(
        &[731, 732, 750],
        "canned cycles of lathes",
        refused("a cycle's motion is the controller's own", WRITE_MOVES),
    ),
    g(
        &[730, 740, 760],
        "canned cycles",
        refused("a canned cycle's motion is the controller's own", EXPAND),
    ),
    g(&[800], "motion mode off", Understood),
    g(
        &[810, 820, 830, 840, 850, 860, 870, 880, 890],
        "canned cycles",
        refused("a canned cycle's motion is the controller's own", EXPAND),
    ),
    g(
        &[900, 901, 910, 911],
        "absolute and incremental coordinates and arc centres",
        Understood,
    ),
    g(
        &[920, 921, 922, 923],
        "set, clear, suspend, resume the position offset",
        Understood,
    ),
    g(&[930, 940, 950], "feed modes", Understood),
    g(&[960, 970], "spindle speed modes", Carried),
    g(&[980, 990], "return level of canned cycles", Carried),
    m(&[0, 10], "stop", Carried),
    m(&[20], "end of program", Understood),
    m(&[300], "end of program", Understood),
    m(
        &[470],
        "repeat the program",
        refused(
            "it starts again from wherever the tool is",
            "remove it and start the program again by hand",
        ),
    ),
    m(
        &[720],
        "restore modal state",
        refused(
            "it brings back modes that were saved elsewhere",
            "write the modes as words",
        ),
    ),
    m(&[820, 830], "absolute, relative extruder words", Understood),
    m(
        &[1280, 1290],
        "tool centre point control",
        refused(
            "it changes where the tool point goes",
            "write the program for the tool point without it",
        ),
    ),
    m(
        &[2060],
        "home offsets",
        refused(
            "it shifts all coordinates",
            "set the offsets at the machine",
        ),
    ),
    m(
        &[2180],
        "tool offsets",
        refused(
            "it shifts all coordinates",
            "set the offsets at the machine",
        ),
    ),
    m(
        &[2900],
        "live shift of an axis",
        refused("it moves the tool", "remove it"),
    ),
    m(
        &[4280],
        "home offsets",
        refused(
            "it shifts all coordinates",
            "set the offsets at the machine",
        ),
    ),
    m(
        &[6650, 6660],
        "kinematics of a parallel machine",
        refused("it changes where the tool goes", "set it at the machine"),
    ),
];

/// Line of the table for a code.
pub(crate) fn lookup(letter: char, tenths: u32) -> Option<&'static Code> {
    CODES
        .iter()
        .find(|code| code.letter == letter && code.tenths.contains(&tenths))
}
