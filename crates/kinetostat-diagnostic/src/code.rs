//! Codes of errors.

use schemars::JsonSchema;
use serde::Serialize;

/// Kind of an error: a stable word for programs. Kinds may be added.
///
/// The documentation of a kind is what `kinetostat explain` prints of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum ErrorCode {
    /// The words of the command line are not understood.
    ///
    /// An option or a command is misspelt, or a value is missing. `kinetostat COMMAND --help` lists the options.
    CommandLine,
    /// A value is not possible: not a number, outside its range, or in another form than the one needed.
    ///
    /// The message names the option or key, the value found and the values that are possible. Units are part of the
    /// name: `_mm`, `_n`, `_deg`.
    Value,
    /// Something that the question needs was not given.
    ///
    /// The message names the option of the command line and the key of the job file that state it.
    Missing,
    /// Two statements exclude each other, or state one thing twice and differently.
    ///
    /// Keep one of the two. What the command line says does not silently win over the job file.
    Conflict,
    /// An option or a key has no effect on this question.
    ///
    /// It is refused, and not ignored: whoever gives it expects something of it. Leave it out, or use the command that it is for.
    Unused,
    /// There is no thing of this name.
    ///
    /// The message lists the names that exist, and the nearest one.
    UnknownName,
    /// A file cannot be read: it does not exist, may not be read, or is not text.
    FileNotRead,
    /// The content of a file is not in the form that is needed.
    ///
    /// The message names the line and the form.
    FileForm,
    /// A file cannot be written, exists already, or may not be replaced.
    ///
    /// No output was changed. `--force-overwrite` replaces outputs that exist; inputs are never replaced.
    Output,
    /// What an interrupted run had kept cannot be used to go on with it.
    ///
    /// The question, the program or the kept files have changed since, or cannot be read. `--restart` begins anew.
    Checkpoint,
    /// The system gives no threads or another resource that the work needs.
    System,
    /// The work needs more memory than the system gives.
    Memory,
    /// This program was built without what is asked for.
    ///
    /// Features of the build, as Parquet and PDF, can be left out; build it with its default features.
    NotBuiltIn,
    /// A fault in a model file.
    ///
    /// `kinetostat check MODEL` lists all faults of a model file at once, `kinetostat model schema` prints the format.
    ModelFile,
    /// The model is right, and cannot answer this question.
    ///
    /// It lacks masses, a controller or a joint that the question needs, or it is of another kind of machine.
    ModelUnsuited,
    /// A fault in a job file or a template.
    ///
    /// `kinetostat check JOB` says what a job file states, and lists all its faults at once.
    JobFile,
    /// A statement of a program is refused.
    ///
    /// The program holds something that is not understood, that controllers understand differently, or that the
    /// controller itself refuses. The message names the line, the reason and a remedy. Nothing is left out of a
    /// program in silence.
    ProgramRefused,
    /// The program is understood, and this question does not fit it.
    ///
    /// It states the orientation of its tool where none is corrected, or takes several tools where one is needed.
    ProgramUnsuited,
    /// Measurements and model do not belong together.
    ///
    /// Nothing is fitted to them. Look at both, or measure again.
    NoMatch,
    /// A place cannot be reached.
    ///
    /// The message names the nearest place that was found. Choose a place inside the workspace, or check the limits of the
    /// model and the length of the tool.
    Unreachable,
    /// A command lies outside the limits of its actuator.
    OutsideLimits,
    /// The loops of the mechanism do not close with the given commands.
    NoClosure,
    /// No equilibrium was found under this load.
    ///
    /// The load may be beyond the limit point of the machine: `kinetostat curve` shows how it gives way, and
    /// `kinetostat equilibria` finds all its shapes.
    NotConverged,
    /// The load acts along a direction in which nothing holds the machine.
    ///
    /// Leave that part of the load out, or check the passive joints of the model.
    FreeDirection,
    /// The machine is rigid in the direction that is to move.
    RigidDirection,
    /// The question has no answer, or none was found.
    NoAnswer,
    /// The written program does not keep its tolerance.
    ///
    /// The program was written. The message names the worst line, and what would help.
    ToleranceMissed,
    /// The written program keeps its tolerance only if the stated assumptions hold.
    ///
    /// The program was written. State what is assumed, or measure it.
    Doubtful,
    /// The work was stopped on request; nothing was written.
    Stopped,
    /// A fault of kinetostat itself. Please report it with the command line.
    Internal,
}
