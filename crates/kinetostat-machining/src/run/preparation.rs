//! Preparation of every run: a first look at the program, the load along it, the way of the arm, and the measured part frame.

use kinetostat::number::smaller;
use kinetostat_program::CorrectionField;

use crate::checks::refused::{as_warning, no_motion, of_task};
use crate::field::ModelField;
use crate::limits::Beyond;
use crate::load::along_path::LoadAlongPath;
use crate::load::ramps::Ramped;
use crate::measured_frame::MeasuredFrame;
use crate::postures::arm_course::ArmCourse;
use crate::postures::neighbour::Orientation;
use crate::run::first_look::FirstLook;
use crate::run::points::Solving;
use crate::task::{RunError, Task};
use crate::warning::{Warning, WarningCode};
use crate::watch::{Unwatched, Watch};

/// Refuses what is beyond its limits.
pub(crate) fn refuse(beyond: Vec<Beyond>) -> Result<(), RunError> {
    match beyond.is_empty() {
        true => Ok(()),
        false => Err(RunError::BeyondLimits(beyond)),
    }
}

/// The load along a program in its two readings, the way of an arm that is not the one from home, and the part as it was measured.
pub(crate) struct Preparation<'a> {
    pub load: Ramped<'a>,
    pub course: Option<ArmCourse>,
    pub frame: MeasuredFrame<'a>,
}

impl<'a> Preparation<'a> {
    /// Prepares the analysis of a program as it is.
    ///
    /// # Errors
    /// It has no motion; a load that no cutting has folds the machine over.
    pub fn of_analysis(
        task: &Task<'a>,
        whole: Option<&OfWhole>,
        watch: &dyn Watch,
    ) -> Result<Self, RunError> {
        has_motion(task)?;
        let load = load(task);
        let looked = FirstLook::new(task, &load, watch)?;
        refuse(looked.folding_load(task))?;
        Self::with(task, load, stiffness(&looked, whole))
    }

    /// Prepares the correction of a program.
    ///
    /// # Errors
    /// It has no motion; load or tool are beyond their limits, or corrections by far; its first place has no answer.
    pub fn of_correction(
        task: &Task<'a>,
        whole: Option<&OfWhole>,
        watch: &dyn Watch,
    ) -> Result<Self, RunError> {
        refuse(of_task(task))?;
        has_motion(task)?;
        let load = load(task);
        let looked = FirstLook::new(task, &load, watch)?.beginning_solved()?;
        refuse(looked.gross(task))?;
        Self::with(task, load, stiffness(&looked, whole))
    }

    fn with(task: &Task<'a>, load: LoadAlongPath<'a>, stiffness: f64) -> Result<Self, RunError> {
        let course = ArmCourse::of(task);
        Ok(Self {
            load: load.ramped(stiffness),
            frame: MeasuredFrame::of(task, course.as_ref())?,
            course,
        })
    }

    /// Solves the program as it is, or as it is written.
    pub fn solving(&self, written: bool) -> Solving<'_> {
        Solving {
            orientation: Orientation::default(),
            written,
            course: self.course.as_ref(),
            frame: &self.frame,
        }
    }

    /// The corrections of the model along the program.
    pub fn field<'f>(&'f self, task: &'f Task<'_>) -> ModelField<'f> {
        ModelField::new(task.mechanism, task.placement, &self.load.followed)
            .correcting(task.corrected)
            .on_course(self.course.as_ref())
            .in_frame(&self.frame)
    }
}

/// The smallest stiffness that was found; of a part of a longer program that of the whole.
fn stiffness(looked: &FirstLook, whole: Option<&OfWhole>) -> f64 {
    whole.map_or_else(|| looked.stiffness(), |whole| whole.stiffness_n_per_mm)
}

/// Calls `work` with the field of corrections that a compensation of this task is written with.
///
/// # Errors
/// As [`crate::compensate_program`], of what is found before its points are solved.
pub fn with_model_field<R>(
    task: &Task<'_>,
    watch: &dyn Watch,
    work: impl FnOnce(&dyn CorrectionField) -> R,
) -> Result<R, RunError> {
    let prepared = Preparation::of_correction(task, None, watch)?;
    Ok(work(&prepared.field(task)))
}

/// Stated load along the program.
pub(crate) fn load<'a>(task: &Task<'a>) -> LoadAlongPath<'a> {
    LoadAlongPath::with_tools(task.load, task.path(), task.tools).with_cut(task.cut)
}

/// Refuses a program that moves nothing; a part of a longer one may.
pub(crate) fn has_motion(task: &Task<'_>) -> Result<(), RunError> {
    if task.path().part.is_some() {
        return Ok(());
    }
    match no_motion(task.path()) {
        Some(reason) => Err(RunError::NoMotion(reason)),
        None => Ok(()),
    }
}

/// Facts about a whole program for the run of a part of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OfWhole {
    /// Moves of the whole program, over which the places of a first look are spread.
    pub moves: usize,
    /// Smallest stiffness against a force at the places that a first look took, N/mm; infinite before the first.
    pub stiffness_n_per_mm: f64,
    /// The program is left as it is: it keeps its tolerance so, or nothing can be written.
    pub as_it_is: bool,
}

impl OfWhole {
    /// Adds the facts found in another part.
    pub fn add(&mut self, found: &Self) {
        self.stiffness_n_per_mm = smaller(self.stiffness_n_per_mm, found.stiffness_n_per_mm);
    }
}

impl Default for OfWhole {
    fn default() -> Self {
        Self {
            moves: 0,
            stiffness_n_per_mm: f64::INFINITY,
            as_it_is: false,
        }
    }
}

/// A first look at a part of a whole program, to be added to what is found in the others; `compensate`: it is to be corrected. A
/// program that takes hours to be solved everywhere is refused here, at some places of every part; the smallest stiffness is that
/// of the places which a first look at the whole program takes, so that it does not depend on how long the parts are.
///
/// # Errors
/// A load under which the machine folds over, or corrections that are beyond their limits by far.
pub fn look_at_part(
    whole: OfWhole,
    task: &Task<'_>,
    compensate: bool,
    watch: &dyn Watch,
) -> Result<OfWhole, RunError> {
    let load: LoadAlongPath<'_> = load(task);
    let looked = FirstLook::new(task, &load, watch)?;
    refuse(match compensate {
        true => looked.gross(task),
        false => looked.folding_load(task),
    })?;
    let of_whole = FirstLook::of_whole(task, &load, whole.moves, watch)?;
    Ok(OfWhole {
        stiffness_n_per_mm: of_whole.stiffness(),
        ..whole
    })
}

/// Reasons for which a compensation refuses a question before anything is solved along the whole program, as warnings, and its
/// first error. `is_placed`: the tool stands as the task says, and not as it is still to be chosen, so that figures at places
/// count.
#[must_use]
pub fn refused_question(task: &Task<'_>, is_placed: bool) -> (Vec<Warning>, Option<RunError>) {
    let mut errors = Vec::new();
    errors.extend(refuse(of_task(task)).err());
    match no_motion(task.path()) {
        Some(reason) => errors.push(RunError::NoMotion(reason)),
        None => match FirstLook::new(task, &load(task), &Unwatched) {
            Err(error) => errors.push(error),
            Ok(looked) if is_placed => {
                errors.extend(refuse(looked.beyond(task)).err());
                errors.extend(looked.beginning_solved().err());
            }
            Ok(_) => {}
        },
    }
    let said = errors.iter().flat_map(|error| match error {
        RunError::BeyondLimits(beyond) => beyond.iter().map(as_warning).collect(),
        error => vec![Warning::new(WarningCode::Program, error.to_string())],
    });
    (said.collect(), errors.into_iter().next())
}
