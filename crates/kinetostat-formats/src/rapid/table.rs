//! Treatment of each statement of RAPID.

use crate::table::Treatment::{Carried, Refused, Understood};
use crate::table::{Alike, StatementRow, Treatment, alike, count, line, row_of, rows, sorted};
use crate::text::Name;

const KERNEL: &str = "ABB, Technical reference manual - RAPID kernel";
const INSTRUCTIONS: &str =
    "ABB, Technical reference manual - RAPID Instructions, Functions and Data types";
const ARC: &str = "ABB, Application manual - Arc and Arc Sensor";
const TRACKING: &str = "ABB, Application manual - Conveyor tracking";
const SYNCHRONISED: &str = "ABB, Application manual - MultiMove";

const SEARCHED: Treatment = Refused {
    reason: "it ends where a signal changes, which only the run decides",
    remedy: "search in a program of its own and state the place found",
};
const DISPLACED: Treatment = Refused {
    reason: "it displaces all motions behind it",
    remedy: "write the displacement into the work object, or take this statement into a program of its own",
};
const AT_RUN_TIME: Treatment = Refused {
    reason: "it corrects the path while it runs",
    remedy: "take this statement into a program of its own",
};
const BY_NAME: Treatment = Refused {
    reason: "it changes data by names that are texts: which targets, tools and work objects change is not followed",
    remedy: "write the assignment by the name of the datum, or take this statement into a program of its own",
};
const OWN_WAY: Treatment = Refused {
    reason: "its motion is not followed",
    remedy: "write it as MoveL, MoveC or MoveJ, or take it into a program of its own",
};
const MOVED_FRAME: Treatment = Refused {
    reason: "the work object moves with the conveyor",
    remedy: "a moving work piece is not corrected: take this statement into a program of its own",
};
/// Treatment of an instruction that moves external axes while the arm does not move.
pub(crate) const EXTERNAL: Treatment = Refused {
    reason: "it moves external axes alone, or displaces them",
    remedy: "take it into a program of its own, or read with external axes carried",
};

/// Settings of how motions run: path mode, acceleration, configurations, orientation.
pub(crate) const MODES: &[&[&str]] = &[
    &["SINGAREA"],
    &["CIRPATHMODE"],
    &["CONFL"],
    &["CONFJ"],
    &["ACCSET"],
    &["PATHACCLIM"],
    &["WORLDACCLIM"],
    &["PATHRESOL"],
    &["TUNESERVO", "TUNERESET"],
    &["GRIPLOAD"],
    &["MECHUNITLOAD"],
];

/// How the end of a motion is stated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Ends {
    /// `ToPoint`, joints in step.
    Joint,
    /// `ToPoint`, straight.
    Linear,
    /// `CirPoint, ToPoint`.
    Circular,
    /// `ToJointPos`.
    AbsoluteJoint,
}

/// The arguments of a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct MotionRow {
    pub name: &'static str,
    pub ends: Ends,
    /// Arguments between speed and zone.
    pub between: usize,
    /// The words of a straight piece before its end, and of its straight end; none where it cannot be divided.
    pub straight: Option<(&'static str, &'static str)>,
    source: &'static str,
}

const fn motion(
    name: &'static str,
    ends: Ends,
    between: usize,
    straight: Option<(&'static str, &'static str)>,
    source: &'static str,
) -> MotionRow {
    MotionRow {
        name,
        ends,
        between,
        straight,
        source,
    }
}

/// All motions that are understood.
pub(crate) const MOTIONS: [MotionRow; 30] = [
    motion(
        "MoveL",
        Ends::Linear,
        0,
        Some(("MoveL", "MoveL")),
        INSTRUCTIONS,
    ),
    motion("MoveJ", Ends::Joint, 0, None, INSTRUCTIONS),
    motion(
        "MoveC",
        Ends::Circular,
        0,
        Some(("MoveL", "MoveL")),
        INSTRUCTIONS,
    ),
    motion("MoveAbsJ", Ends::AbsoluteJoint, 0, None, INSTRUCTIONS),
    motion("MoveLDO", Ends::Linear, 0, None, INSTRUCTIONS),
    motion("MoveJDO", Ends::Joint, 0, None, INSTRUCTIONS),
    motion("MoveCDO", Ends::Circular, 0, None, INSTRUCTIONS),
    motion("MoveLAO", Ends::Linear, 0, None, INSTRUCTIONS),
    motion("MoveJAO", Ends::Joint, 0, None, INSTRUCTIONS),
    motion("MoveCAO", Ends::Circular, 0, None, INSTRUCTIONS),
    motion("MoveLGO", Ends::Linear, 0, None, INSTRUCTIONS),
    motion("MoveJGO", Ends::Joint, 0, None, INSTRUCTIONS),
    motion("MoveCGO", Ends::Circular, 0, None, INSTRUCTIONS),
    motion("MoveLSync", Ends::Linear, 0, None, INSTRUCTIONS),
    motion("MoveJSync", Ends::Joint, 0, None, INSTRUCTIONS),
    motion("MoveCSync", Ends::Circular, 0, None, INSTRUCTIONS),
    motion("TriggL", Ends::Linear, 1, None, INSTRUCTIONS),
    motion("TriggJ", Ends::Joint, 1, None, INSTRUCTIONS),
    motion("TriggC", Ends::Circular, 1, None, INSTRUCTIONS),
    motion("ArcL", Ends::Linear, 2, Some(("ArcL", "ArcL")), ARC),
    motion("ArcLStart", Ends::Linear, 2, None, ARC),
    motion("ArcLEnd", Ends::Linear, 2, Some(("ArcL", "ArcLEnd")), ARC),
    motion("ArcC", Ends::Circular, 2, Some(("ArcL", "ArcL")), ARC),
    motion("ArcCStart", Ends::Circular, 2, None, ARC),
    motion("ArcCEnd", Ends::Circular, 2, Some(("ArcL", "ArcLEnd")), ARC),
    motion("ArcL1", Ends::Linear, 2, Some(("ArcL1", "ArcL1")), ARC),
    motion("ArcL2", Ends::Linear, 2, Some(("ArcL2", "ArcL2")), ARC),
    motion("ArcC1", Ends::Circular, 2, Some(("ArcL1", "ArcL1")), ARC),
    motion("ArcC2", Ends::Circular, 2, Some(("ArcL2", "ArcL2")), ARC),
    motion("ArcMoveL", Ends::Linear, 0, None, ARC),
];

/// The motion of a name.
pub(crate) fn motion_row(name: &Name) -> Option<&'static MotionRow> {
    let letters = name.letters();
    let begins = letters.starts_with(b"MOVE")
        || letters.starts_with(b"ARC")
        || letters.starts_with(b"TRIGG");
    let found = || {
        MOTIONS
            .iter()
            .find(|row| row.name.as_bytes().eq_ignore_ascii_case(letters))
    };
    begins.then(found)?
}

/// The row of a statement by its name.
pub(crate) fn row(name: &Name) -> Option<&'static StatementRow> {
    row_of(&SORTED, name)
}

/// Treatment of each statement of RAPID, in alphabetical order. Procedures that are neither in a file nor listed are carried with a finding.
pub const RAPID_STATEMENTS: &[StatementRow] = &SORTED;

const COUNT: usize = count(OTHERS) + MOTIONS.len();

/// Motions and others in order of their names in capitals.
static SORTED: [StatementRow; COUNT] = {
    let mut all = rows::<COUNT>(OTHERS);
    let mut at = 0;
    while at < MOTIONS.len() {
        all[count(OTHERS) + at] = line(MOTIONS[at].name, Understood, MOTIONS[at].source);
        at += 1;
    }
    sorted(all)
};

#[rustfmt::skip]
const OTHERS: &[Alike] = &[
    alike(Understood, KERNEL, &[
        "MODULE", "RECORD", "PROC", "FUNC", "TRAP", "CONST", "PERS", "VAR", "IF", "FOR", "WHILE",
        "TEST", "GOTO", "RETURN", "EXIT", "RAISE", "RETRY", "TRYNEXT", "ERROR", "UNDO", "BACKWARD",
        ":=",
    ]),
    alike(Understood, INSTRUCTIONS, &["Offs", "RelTool", "CirPathMode", "SingArea", "PDispSet", "PDispOff"]),
    alike(Carried, INSTRUCTIONS, &[
        "AccSet", "Add", "AliasIO", "AliasIOReset", "BitClear", "BitSet", "BookErrNo", "Break",
        "CheckProgRef", "Clear", "ClearIOBuff", "ClearRawBytes", "ClkReset", "ClkStart", "ClkStop",
        "Close", "CloseDir", "ConfJ", "ConfL", "CONNECT", "CopyFile", "CopyRawBytes",
        "DeactEventBuffer", "Decr", "EraseModule", "ErrLog", "ErrWrite", "ExitCycle", "GripLoad",
        "IDelete", "IDisable", "IEnable", "IError", "Incr", "InvertDO", "IOBusState", "IODisable",
        "IOEnable", "IPers", "ISignalAI", "ISignalAO", "ISignalDI", "ISignalDO", "ISignalGI",
        "ISignalGO", "ISleep", "ITimer", "IVarValue", "IWatch", "Load", "MakeDir", "MechUnitLoad",
        "MotionSup", "Open", "OpenDir", "PathAccLim", "PathRecStart", "PathRecStop", "PathResol",
        "PulseDO", "RemoveDir", "RemoveFile", "Reset", "ResetRetryCount", "Rewind", "Save", "Set",
        "SetAO", "SetDO", "SetGO", "SocketClose", "SocketConnect", "SocketCreate", "SocketSend",
        "SpeedRefresh", "SpyStart", "SpyStop", "StartLoad", "StopMoveReset", "SystemStopAction",
        "TextTabInstall", "TPErase", "TPShow", "TPWrite", "TuneReset", "TuneServo", "UIMsgBox",
        "UIShow", "UnLoad", "VelSet", "WaitDI", "WaitDO", "WaitGI", "WaitGO", "WaitAI", "WaitAO",
        "WaitLoad", "WaitTestAndSet", "WaitTime", "WaitUntil", "WarmStart", "WaitRob",
        "WorldAccLim", "Write", "WriteBin", "WriteStrBin", "WriteAnyBin", "WriteVar", "Stop",
        "TriggIO", "TriggEquip", "TriggInt", "TriggSpeed", "TriggCheckIO", "TriggRampAO",
        "ActEventBuffer", "EOffsOff", "CorrClear", "RestoPath", "StorePath",
        "StartMove", "StopMove", "StartMoveRetry", "ActUnit", "DeactUnit",
    ]),
    alike(Carried, ARC, &["ArcRefresh"]),
    alike(Refused {
        reason: "it leaves motions before their ends",
        remedy: "take the trap or the handler that clears the path into a module of its own",
    }, INSTRUCTIONS, &["ClearPath"]),
    alike(BY_NAME, INSTRUCTIONS, &["SetAllDataVal", "SetDataVal"]),
    alike(Carried, SYNCHRONISED, &[
        "WaitSyncTask", "SyncMoveOn", "SyncMoveOff", "SyncMoveResume", "SyncMoveSuspend",
    ]),
    alike(Refused {
        reason: "it goes back along the way that was run",
        remedy: "take the event routine that steps back into a module of its own",
    }, INSTRUCTIONS, &["StepBwdPath"]),
    alike(SEARCHED, INSTRUCTIONS, &["SearchL", "SearchC", "SearchJ", "SearchExtJ"]),
    alike(DISPLACED, INSTRUCTIONS, &["PDispOn"]),
    alike(AT_RUN_TIME, INSTRUCTIONS, &[
        "CorrCon", "CorrWrite", "CorrDiscon", "EGMRunJoint", "EGMRunPose", "EGMMoveL", "EGMMoveC",
        "SoftAct", "FCAct", "FCPress1LStart", "FCPressL", "FCPressC", "FCPressEnd",
    ]),
    alike(OWN_WAY, INSTRUCTIONS, &[
        "SpotL", "SpotJ", "SpotML", "SpotMJ", "PaintL", "PaintC", "DispL", "DispC", "TriggLIOs",
        "TriggJIOs", "LaserL", "LaserC", "CapL", "CapC", "PathRecMoveBwd", "PathRecMoveFwd",
        "IndAMove", "IndCMove", "IndDMove", "IndRMove",
    ]),
    alike(MOVED_FRAME, TRACKING, &["WaitWObj", "DropWObj"]),
    alike(EXTERNAL, INSTRUCTIONS, &["MoveExtJ", "EOffsOn", "EOffsSet"]),
];
