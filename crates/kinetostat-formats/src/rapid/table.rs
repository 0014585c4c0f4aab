//! What is done with each statement of RAPID, as data.

use crate::table::Treatment::{Carried, Refused, Understood};
use crate::table::{StatementRow, Treatment, comes_before, line};
use crate::text::name::Name;

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
/// Of an instruction that moves external axes while the arm stands still.
pub(crate) const EXTERNAL: Treatment = Refused {
    reason: "it moves external axes alone",
    remedy: "take it into a program of its own, or read with external axes carried",
};

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
    let letters = name.letters();
    let key = |row: &StatementRow| row.name.bytes().map(|byte| byte.to_ascii_uppercase());
    let found = SORTED.binary_search_by(|row| key(row).cmp(letters.iter().copied()));
    found.ok().map(|index| &SORTED[index])
}

/// What is done with each statement of RAPID, in the order of the alphabet. Procedures that are in no file and not here
/// are carried with a finding.
pub const RAPID_STATEMENTS: &[StatementRow] = &SORTED;

const COUNT: usize = OTHERS.len() + MOTIONS.len();

/// Motions and others in order of their names in capitals.
static SORTED: [StatementRow; COUNT] = sorted();

const fn sorted() -> [StatementRow; COUNT] {
    let mut all = [OTHERS[0]; COUNT];
    let mut filled = 0;
    while filled < COUNT {
        let next = match filled < OTHERS.len() {
            true => OTHERS[filled],
            false => {
                let motion = MOTIONS[filled - OTHERS.len()];
                line(motion.name, Understood, motion.source)
            }
        };
        let mut at = filled;
        while at > 0 && comes_before(next.name.as_bytes(), all[at - 1].name.as_bytes()) {
            all[at] = all[at - 1];
            at -= 1;
        }
        all[at] = next;
        filled += 1;
    }
    all
}

#[rustfmt::skip]
const OTHERS: [StatementRow; 205] = [
    line("MODULE", Understood, KERNEL),
    line("RECORD", Understood, KERNEL),
    line("PROC", Understood, KERNEL),
    line("FUNC", Understood, KERNEL),
    line("TRAP", Understood, KERNEL),
    line("CONST", Understood, KERNEL),
    line("PERS", Understood, KERNEL),
    line("VAR", Understood, KERNEL),
    line("IF", Understood, KERNEL),
    line("FOR", Understood, KERNEL),
    line("WHILE", Understood, KERNEL),
    line("TEST", Understood, KERNEL),
    line("GOTO", Understood, KERNEL),
    line("RETURN", Understood, KERNEL),
    line("EXIT", Understood, KERNEL),
    line("RAISE", Understood, KERNEL),
    line("RETRY", Understood, KERNEL),
    line("TRYNEXT", Understood, KERNEL),
    line("ERROR", Understood, KERNEL),
    line("UNDO", Understood, KERNEL),
    line("BACKWARD", Understood, KERNEL),
    line(":=", Understood, KERNEL),
    line("Offs", Understood, INSTRUCTIONS),
    line("RelTool", Understood, INSTRUCTIONS),
    line("AccSet", Carried, INSTRUCTIONS),
    line("AliasIO", Carried, INSTRUCTIONS),
    line("AliasIOReset", Carried, INSTRUCTIONS),
    line("ArcRefresh", Carried, ARC),
    line("BitClear", Carried, INSTRUCTIONS),
    line("BitSet", Carried, INSTRUCTIONS),
    line("BookErrNo", Carried, INSTRUCTIONS),
    line("Break", Carried, INSTRUCTIONS),
    line("CheckProgRef", Carried, INSTRUCTIONS),
    line("CirPathMode", Understood, INSTRUCTIONS),
    line("Clear", Carried, INSTRUCTIONS),
    line("ClearIOBuff", Carried, INSTRUCTIONS),
    line("ClearPath", Refused {
        reason: "it leaves motions before their ends",
        remedy: "take the trap or the handler that clears the path into a module of its own",
    }, INSTRUCTIONS),
    line("ClearRawBytes", Carried, INSTRUCTIONS),
    line("ClkReset", Carried, INSTRUCTIONS),
    line("ClkStart", Carried, INSTRUCTIONS),
    line("ClkStop", Carried, INSTRUCTIONS),
    line("Close", Carried, INSTRUCTIONS),
    line("CloseDir", Carried, INSTRUCTIONS),
    line("ConfJ", Carried, INSTRUCTIONS),
    line("ConfL", Carried, INSTRUCTIONS),
    line("CONNECT", Carried, INSTRUCTIONS),
    line("CopyFile", Carried, INSTRUCTIONS),
    line("CopyRawBytes", Carried, INSTRUCTIONS),
    line("DeactEventBuffer", Carried, INSTRUCTIONS),
    line("Decr", Carried, INSTRUCTIONS),
    line("EraseModule", Carried, INSTRUCTIONS),
    line("ErrLog", Carried, INSTRUCTIONS),
    line("ErrWrite", Carried, INSTRUCTIONS),
    line("ExitCycle", Carried, INSTRUCTIONS),
    line("GripLoad", Carried, INSTRUCTIONS),
    line("IDelete", Carried, INSTRUCTIONS),
    line("IDisable", Carried, INSTRUCTIONS),
    line("IEnable", Carried, INSTRUCTIONS),
    line("IError", Carried, INSTRUCTIONS),
    line("Incr", Carried, INSTRUCTIONS),
    line("InvertDO", Carried, INSTRUCTIONS),
    line("IOBusState", Carried, INSTRUCTIONS),
    line("IODisable", Carried, INSTRUCTIONS),
    line("IOEnable", Carried, INSTRUCTIONS),
    line("IPers", Carried, INSTRUCTIONS),
    line("ISignalAI", Carried, INSTRUCTIONS),
    line("ISignalAO", Carried, INSTRUCTIONS),
    line("ISignalDI", Carried, INSTRUCTIONS),
    line("ISignalDO", Carried, INSTRUCTIONS),
    line("ISignalGI", Carried, INSTRUCTIONS),
    line("ISignalGO", Carried, INSTRUCTIONS),
    line("ISleep", Carried, INSTRUCTIONS),
    line("ITimer", Carried, INSTRUCTIONS),
    line("IVarValue", Carried, INSTRUCTIONS),
    line("IWatch", Carried, INSTRUCTIONS),
    line("Load", Carried, INSTRUCTIONS),
    line("MakeDir", Carried, INSTRUCTIONS),
    line("MechUnitLoad", Carried, INSTRUCTIONS),
    line("MotionSup", Carried, INSTRUCTIONS),
    line("Open", Carried, INSTRUCTIONS),
    line("OpenDir", Carried, INSTRUCTIONS),
    line("PathAccLim", Carried, INSTRUCTIONS),
    line("PathRecStart", Carried, INSTRUCTIONS),
    line("PathRecStop", Carried, INSTRUCTIONS),
    line("PathResol", Carried, INSTRUCTIONS),
    line("PulseDO", Carried, INSTRUCTIONS),
    line("RemoveDir", Carried, INSTRUCTIONS),
    line("RemoveFile", Carried, INSTRUCTIONS),
    line("Reset", Carried, INSTRUCTIONS),
    line("ResetRetryCount", Carried, INSTRUCTIONS),
    line("Rewind", Carried, INSTRUCTIONS),
    line("Save", Carried, INSTRUCTIONS),
    line("Set", Carried, INSTRUCTIONS),
    line("SetAllDataVal", BY_NAME, INSTRUCTIONS),
    line("SetDataVal", BY_NAME, INSTRUCTIONS),
    line("SetAO", Carried, INSTRUCTIONS),
    line("SetDO", Carried, INSTRUCTIONS),
    line("SetGO", Carried, INSTRUCTIONS),
    line("SingArea", Understood, INSTRUCTIONS),
    line("SocketClose", Carried, INSTRUCTIONS),
    line("SocketConnect", Carried, INSTRUCTIONS),
    line("SocketCreate", Carried, INSTRUCTIONS),
    line("SocketSend", Carried, INSTRUCTIONS),
    line("SpeedRefresh", Carried, INSTRUCTIONS),
    line("SpyStart", Carried, INSTRUCTIONS),
    line("SpyStop", Carried, INSTRUCTIONS),
    line("StartLoad", Carried, INSTRUCTIONS),
    line("StopMoveReset", Carried, INSTRUCTIONS),
    line("SystemStopAction", Carried, INSTRUCTIONS),
    line("TextTabInstall", Carried, INSTRUCTIONS),
    line("TPErase", Carried, INSTRUCTIONS),
    line("TPShow", Carried, INSTRUCTIONS),
    line("TPWrite", Carried, INSTRUCTIONS),
    line("TuneReset", Carried, INSTRUCTIONS),
    line("TuneServo", Carried, INSTRUCTIONS),
    line("UIMsgBox", Carried, INSTRUCTIONS),
    line("UIShow", Carried, INSTRUCTIONS),
    line("UnLoad", Carried, INSTRUCTIONS),
    line("VelSet", Carried, INSTRUCTIONS),
    line("WaitDI", Carried, INSTRUCTIONS),
    line("WaitDO", Carried, INSTRUCTIONS),
    line("WaitGI", Carried, INSTRUCTIONS),
    line("WaitGO", Carried, INSTRUCTIONS),
    line("WaitAI", Carried, INSTRUCTIONS),
    line("WaitAO", Carried, INSTRUCTIONS),
    line("WaitLoad", Carried, INSTRUCTIONS),
    line("WaitSyncTask", Carried, SYNCHRONISED),
    line("WaitTestAndSet", Carried, INSTRUCTIONS),
    line("WaitTime", Carried, INSTRUCTIONS),
    line("WaitUntil", Carried, INSTRUCTIONS),
    line("WarmStart", Carried, INSTRUCTIONS),
    line("WaitRob", Carried, INSTRUCTIONS),
    line("WorldAccLim", Carried, INSTRUCTIONS),
    line("Write", Carried, INSTRUCTIONS),
    line("WriteBin", Carried, INSTRUCTIONS),
    line("WriteStrBin", Carried, INSTRUCTIONS),
    line("WriteAnyBin", Carried, INSTRUCTIONS),
    line("WriteVar", Carried, INSTRUCTIONS),
    line("Stop", Carried, INSTRUCTIONS),
    line("StepBwdPath", Refused {
        reason: "it goes back along the way that was run",
        remedy: "take the event routine that steps back into a module of its own",
    }, INSTRUCTIONS),
    line("SyncMoveOn", Carried, SYNCHRONISED),
    line("SyncMoveOff", Carried, SYNCHRONISED),
    line("SyncMoveResume", Carried, SYNCHRONISED),
    line("SyncMoveSuspend", Carried, SYNCHRONISED),
    line("TriggIO", Carried, INSTRUCTIONS),
    line("TriggEquip", Carried, INSTRUCTIONS),
    line("TriggInt", Carried, INSTRUCTIONS),
    line("TriggSpeed", Carried, INSTRUCTIONS),
    line("TriggCheckIO", Carried, INSTRUCTIONS),
    line("TriggRampAO", Carried, INSTRUCTIONS),
    line("ActEventBuffer", Carried, INSTRUCTIONS),
    line("EOffsOff", Carried, INSTRUCTIONS),
    line("PDispOff", Carried, INSTRUCTIONS),
    line("CorrClear", Carried, INSTRUCTIONS),
    line("SearchL", SEARCHED, INSTRUCTIONS),
    line("SearchC", SEARCHED, INSTRUCTIONS),
    line("SearchJ", SEARCHED, INSTRUCTIONS),
    line("SearchExtJ", SEARCHED, INSTRUCTIONS),
    line("PDispOn", DISPLACED, INSTRUCTIONS),
    line("PDispSet", DISPLACED, INSTRUCTIONS),
    line("EOffsOn", DISPLACED, INSTRUCTIONS),
    line("EOffsSet", DISPLACED, INSTRUCTIONS),
    line("CorrCon", AT_RUN_TIME, INSTRUCTIONS),
    line("CorrWrite", AT_RUN_TIME, INSTRUCTIONS),
    line("CorrDiscon", AT_RUN_TIME, INSTRUCTIONS),
    line("EGMRunJoint", AT_RUN_TIME, INSTRUCTIONS),
    line("EGMRunPose", AT_RUN_TIME, INSTRUCTIONS),
    line("EGMMoveL", AT_RUN_TIME, INSTRUCTIONS),
    line("EGMMoveC", AT_RUN_TIME, INSTRUCTIONS),
    line("SoftAct", AT_RUN_TIME, INSTRUCTIONS),
    line("FCAct", AT_RUN_TIME, INSTRUCTIONS),
    line("FCPress1LStart", AT_RUN_TIME, INSTRUCTIONS),
    line("FCPressL", AT_RUN_TIME, INSTRUCTIONS),
    line("FCPressC", AT_RUN_TIME, INSTRUCTIONS),
    line("FCPressEnd", AT_RUN_TIME, INSTRUCTIONS),
    line("SpotL", OWN_WAY, INSTRUCTIONS),
    line("SpotJ", OWN_WAY, INSTRUCTIONS),
    line("SpotML", OWN_WAY, INSTRUCTIONS),
    line("SpotMJ", OWN_WAY, INSTRUCTIONS),
    line("PaintL", OWN_WAY, INSTRUCTIONS),
    line("PaintC", OWN_WAY, INSTRUCTIONS),
    line("DispL", OWN_WAY, INSTRUCTIONS),
    line("DispC", OWN_WAY, INSTRUCTIONS),
    line("TriggLIOs", OWN_WAY, INSTRUCTIONS),
    line("TriggJIOs", OWN_WAY, INSTRUCTIONS),
    line("LaserL", OWN_WAY, INSTRUCTIONS),
    line("LaserC", OWN_WAY, INSTRUCTIONS),
    line("CapL", OWN_WAY, INSTRUCTIONS),
    line("CapC", OWN_WAY, INSTRUCTIONS),
    line("PathRecMoveBwd", OWN_WAY, INSTRUCTIONS),
    line("PathRecMoveFwd", OWN_WAY, INSTRUCTIONS),
    line("RestoPath", Carried, INSTRUCTIONS),
    line("StorePath", Carried, INSTRUCTIONS),
    line("StartMove", Carried, INSTRUCTIONS),
    line("StopMove", Carried, INSTRUCTIONS),
    line("StartMoveRetry", Carried, INSTRUCTIONS),
    line("IndAMove", OWN_WAY, INSTRUCTIONS),
    line("IndCMove", OWN_WAY, INSTRUCTIONS),
    line("IndDMove", OWN_WAY, INSTRUCTIONS),
    line("IndRMove", OWN_WAY, INSTRUCTIONS),
    line("WaitWObj", MOVED_FRAME, TRACKING),
    line("DropWObj", MOVED_FRAME, TRACKING),
    line("MoveExtJ", EXTERNAL, INSTRUCTIONS),
    line("ActUnit", Carried, INSTRUCTIONS),
    line("DeactUnit", Carried, INSTRUCTIONS),
];
