//! The program of a run, read and interpreted.

use kinetostat::Directions;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_program::{
    Gcode, MachineProgram, Part, Path as ToolPath, Program, ProgramError, ReadOptions, Warning,
    faults, interpret,
};

use crate::job::expansion::advice::advice;
use crate::job::robot::read_program::{RobotRead, read_robot};
use crate::job::setting::Setting;
use crate::ui::failure::{Answer, Failing};
use crate::ui::fault_list::{fault_list_text, with_text};

/// A program that was read, with its path.
pub(crate) enum ReadProgram<'s> {
    Gcode(Box<GcodeRead<'s>>),
    Robot(Box<RobotRead<'s>>),
    /// A part of a long program.
    Part(PartRead<'s>),
}

/// A part of a long program, to be written behind the parts before it.
#[derive(Clone, Copy)]
pub(crate) struct PartRead<'s> {
    pub(crate) part: &'s Part,
    /// Program as it is written.
    pub(crate) program: &'s dyn MachineProgram,
    pub(crate) setting: &'s Setting,
}

/// A program in G-code with its path, and how it was read.
pub(crate) struct GcodeRead<'s> {
    program: Program,
    path: ToolPath,
    setting: &'s Setting,
}

impl ReadProgram<'_> {
    /// Path of the tool.
    pub(crate) fn path(&self) -> &ToolPath {
        match self {
            Self::Gcode(read) => &read.path,
            Self::Robot(read) => &read.path.path,
            Self::Part(read) => &read.part.path,
        }
    }

    /// The tool goes along another path, with a turn that the program does not say.
    pub(crate) fn go_along(&mut self, path: ToolPath) {
        match self {
            Self::Gcode(read) => read.path = path,
            Self::Robot(read) => read.path.to_mut().path = path,
            // Programs whose turn is chosen are not run in parts.
            Self::Part(_) => {}
        }
    }

    /// The program in G-code, if it is one.
    pub(crate) fn gcode(&self) -> Option<(&Program, &ToolPath)> {
        match self {
            Self::Gcode(read) => Some((&read.program, &read.path)),
            Self::Robot(_) | Self::Part(_) => None,
        }
    }

    /// The program of a robot, if it is one.
    pub(crate) fn robot(&self) -> Option<&RobotRead<'_>> {
        match self {
            Self::Gcode(_) | Self::Part(_) => None,
            Self::Robot(read) => Some(read),
        }
    }

    /// Lines of the program's file.
    pub(crate) fn line_count(&self) -> usize {
        match self {
            Self::Gcode(read) => read.program.line_count(),
            Self::Robot(read) => read.program.files[read.path.file].line_count(),
            Self::Part(read) => read.part.next_line() - read.part.first_line(),
        }
    }

    /// Corrected directions of the tool's pose.
    pub(crate) fn corrected(&self) -> Directions {
        match self {
            Self::Gcode(read) => read.setting.correct.directions(),
            Self::Robot(read) => read.corrected(),
            Self::Part(read) => read.setting.correct.directions(),
        }
    }

    /// Applies `work` to the program in the form of a run.
    pub(crate) fn with<R>(&self, work: impl FnOnce(&dyn MachineProgram) -> R) -> R {
        match self {
            Self::Gcode(read) => work(&Gcode {
                program: &read.program,
                path: &read.path,
                reading: &read.setting.reading,
            }),
            Self::Robot(read) => work(&read.correctable()),
            Self::Part(read) => work(read.program),
        }
    }
}

/// Removes the comment with the line of origin from a flat block that is quoted, if the block is in a file of the user.
fn without_origin(setting: &Setting, fault: &mut ProgramError) {
    let flat = setting.flat.as_ref();
    let Some((_, line)) = flat.and_then(|flat| flat.source_of(fault.line)) else {
        return;
    };
    let comment = fault.found.rsplit_once(" (");
    let is_origin = |comment: &str| comment.ends_with(&format!("line {line})"));
    if let Some((block, _)) = comment.filter(|(_, comment)| is_origin(comment)) {
        fault.found = block.to_owned();
    }
}

/// Warns of stated data of the machine and of its tools that no block uses.
fn without_effect(program: &Program, path: &ToolPath, reading: &ReadOptions) -> Vec<Warning> {
    let mut found = Vec::new();
    let [g28, g30] = reading.reference_points_mm;
    let is_unused = |place: Option<_>, codes: &[f64]| place.is_some() && !program.has_g_code(codes);
    let of_zero = [10.0, 28.0, 30.0, 53.0];
    if is_unused(g28, &[28.0])
        || is_unused(g30, &[30.0])
        || is_unused(reading.machine_zero_mm, &of_zero)
    {
        let text = "a place of the machine (machine_zero_mm, g28_mm, g30_mm) is stated, and no block goes by it (G10, G28, G30, G53): it changes nothing".to_owned();
        found.push(Warning::new(1, text));
    }
    let first = path.moves.first().map(|motion| motion.line);
    let named = first.filter(|line| path.tool_on(*line).is_some());
    if let (Some(line), true, true) = (named, reading.tools.is_some(), reading.tool_before_first) {
        let text = "the tool is stated twice: the program has named one of [[tools]] before it moves, whose length counts, and that under [tool] is used nowhere; leave length_mm and pose out there".to_owned();
        found.push(Warning::new(line, text));
    }
    found
}

/// Reads and interprets a program.
pub(crate) fn read_program(setting: &Setting) -> Answer<ReadProgram<'_>> {
    if let Some(source) = &setting.robot {
        let read = read_robot(source).map_err(|failure| setting.of_flat(failure).of_program())?;
        return Ok(ReadProgram::Robot(Box::new(read)));
    }
    let read = Program::read(setting.program.clone()).and_then(|program| {
        let path = interpret(&program, &setting.reading)?;
        Ok((program, path))
    });
    let (program, mut path) = read.map_err(|mut error| {
        let mut all = faults(setting.program.clone(), &setting.reading);
        for fault in all.iter_mut().chain([&mut error]) {
            without_origin(setting, fault);
        }
        let message = fault_list_text("lines", &error, &all);
        let (bytes, path) = (&setting.program, &setting.program_path);
        let first = match setting.flat {
            Some(_) => None,
            None => advice(bytes, path, &setting.reading, &all),
        };
        let text = first.unwrap_or_default() + &message;
        let failure = with_text(ErrorCode::ProgramRefused, text, &error, &all);
        setting.within(failure).of_program()
    })?;
    // A flat program has taken them where it was expanded.
    if setting.flat.is_none() {
        path.warnings
            .extend(without_effect(&program, &path, &setting.reading));
    }
    let states_none = path.moves.iter().all(|motion| motion.tool_turn.is_none());
    if setting.correct.directions() == Directions::ALL && states_none {
        return Err(ErrorCode::ProgramUnsuited.failure("the program does not state how its tool stands (no rotary axis of the model turns with tool centre point control), so that its orientation cannot be corrected: leave out --correct pose (correct = \"pose\" under [robot])",
        ));
    }
    Ok(ReadProgram::Gcode(Box::new(GcodeRead {
        program,
        path,
        setting,
    })))
}
