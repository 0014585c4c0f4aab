//! The ends of motions and of their pieces, as literals and declarations.

use std::ops::Range;

use nalgebra::{Isometry3, UnitQuaternion};

use crate::model::motion::Motion;
use crate::model::program::RobotProgram;
use crate::model::site::{JointsText, OffsetAxes, PoseText, SpeedSite, TargetSite};
use crate::options::WriteOptions;
use crate::text::edits::Edits;
use crate::text::number::Width;
use crate::text::source::SourceFile;
use crate::writing::declared::{Demands, Names};
use crate::writing::piece::{NO_END, NO_JOINTS, NO_NAME, Reason};
use crate::writing::syntax::{Syntax, Wanted, literal_of, put, put_pose};

/// Output written so far.
pub(super) struct Writer<'a> {
    pub program: &'a RobotProgram,
    pub options: &'a WriteOptions,
    pub syntax: &'a dyn Syntax,
    /// One for each file.
    pub edits: Vec<Edits>,
    pub demands: Demands,
    pub names: Names,
}

impl Writer<'_> {
    /// A pose like that of a target: a literal, or the name of a further declaration.
    pub(super) fn literal_near(
        &mut self,
        motion: &Motion,
        site: &TargetSite,
        wanted: &Wanted<'_>,
    ) -> Result<Vec<u8>, Reason> {
        if let TargetSite::Joints(text) = site {
            let end = motion.target.pose().ok_or(NO_END)?;
            let file = &self.program.files[motion.file];
            return row_of_joints(file, text, wanted, end.orientation).ok_or(NO_JOINTS);
        }
        if let TargetSite::Replaced(text) = site {
            let file = &self.program.files[motion.file];
            let literal = self.syntax.replaced(file, text, wanted, self.options);
            return literal.ok_or(NO_END);
        }
        let text = text_of(self.program, site).ok_or(NO_END)?;
        let home = &self.program.files[text.file];
        let literal = literal_of(home, text, wanted, self.options).ok_or(NO_END)?;
        match (self.syntax.declares_pieces(), site) {
            (true, TargetSite::Declared { declaration, .. }) => {
                let declared = self.program.declarations.get(*declaration).ok_or(NO_END)?;
                let (program, syntax) = (self.program, self.syntax);
                (self.names)
                    .declare(program, syntax, declared, &literal, &mut 2, &mut self.edits)
                    .ok_or(NO_NAME)
            }
            _ => Ok(literal),
        }
    }

    pub(super) fn state_speed(&mut self, motion: &Motion, speed: Option<(&SpeedSite, Vec<u8>)>) {
        if let Some((site, text)) = speed {
            self.edits[motion.file].replace(site.span.clone(), text);
        }
    }

    /// Writes one pose of a motion; without a wanted one it stays, which other uses of its declaration must know.
    pub(super) fn write_end(
        &mut self,
        motion: &Motion,
        site: &TargetSite,
        wanted: Option<Wanted<'_>>,
    ) -> Result<(), Reason> {
        let program = self.program;
        let edits = &mut self.edits[motion.file];
        let file = &program.files[motion.file];
        match (site, wanted) {
            (TargetSite::Declared { declaration, name }, wanted) => {
                let declared = program.declarations.get(*declaration).ok_or(NO_END)?;
                let home = &program.files[declared.text.file];
                let literal = match &wanted {
                    Some(wanted) => literal_of(home, &declared.text, wanted, self.options),
                    None => Some(home.part(&declared.text.whole).to_vec()),
                };
                let literal = literal.ok_or(NO_END)?;
                (self.demands).demand(*declaration, motion.file, name.clone(), literal);
            }
            (_, None) => {}
            (TargetSite::Literal(text), Some(wanted)) => {
                put_pose(file, text, &wanted, self.options, edits);
            }
            (TargetSite::Joints(text), Some(wanted)) => {
                let own = motion.target.pose().ok_or(NO_END)?.orientation;
                put_joints(file, text, &wanted, own, edits).ok_or(NO_JOINTS)?;
            }
            (TargetSite::Offset { call, literal, .. }, Some(wanted))
                if wanted.orientation.is_some() =>
            {
                // The arguments cannot turn the tool: the end itself is written in place of the call.
                let home = &program.files[literal.file];
                let text = literal_of(home, literal, &wanted, self.options).ok_or(NO_END)?;
                edits.replace(call.clone(), text);
            }
            (
                TargetSite::Offset {
                    arguments,
                    axes,
                    base,
                    ..
                },
                Some(wanted),
            ) => {
                let by = wanted.position_mm - base.position_mm;
                let by = match axes {
                    OffsetAxes::WorkObject => by,
                    OffsetAxes::Tool => base.orientation.inverse() * by,
                };
                let least = self.options.position_decimals;
                for (number, value) in arguments.iter().zip(by.iter()) {
                    put(file, number, *value, least, Width::Free, edits);
                }
            }
            (TargetSite::Replaced(text), Some(wanted)) => {
                let literal = self.syntax.replaced(file, text, &wanted, self.options);
                edits.replace(text.span.clone(), literal.ok_or(NO_END)?);
            }
            // Coordinates that KRL takes over are stated beforehand.
            (TargetSite::Partial(_), Some(_)) => return Err(NO_END),
            (TargetSite::Fixed(reason), Some(_)) => return Err((reason, NO_END.1)),
        }
        Ok(())
    }
}

/// Minimum decimals of a changed joint value in degrees or mm: 2e-8 rad are 0.05 micrometres at the end of a long arm.
const DECIMALS: f64 = 6.0;

/// Puts the joint values of a pose in place of those of a row; `own` is the orientation at its end. None where the arm does not get
/// there.
fn put_joints(
    file: &SourceFile,
    text: &JointsText,
    wanted: &Wanted<'_>,
    own: UnitQuaternion<f64>,
    edits: &mut Edits,
) -> Option<()> {
    let rotation = wanted.orientation.unwrap_or(own);
    let pose = Isometry3::from_parts(wanted.position_mm.into(), rotation);
    let joints = text.arm.arm.joints_near(&pose, &text.joints())?;
    for ((number, unit), joint) in text.numbers.iter().zip(joints) {
        // Equal resolution in radians and in metres.
        let more = unit.log10().ceil();
        let decimals = (DECIMALS + more) as usize;
        put(file, number, joint / unit, decimals, Width::Free, edits);
    }
    Some(())
}

/// The whole row with the joint values of a pose.
fn row_of_joints(
    file: &SourceFile,
    text: &JointsText,
    wanted: &Wanted<'_>,
    own: UnitQuaternion<f64>,
) -> Option<Vec<u8>> {
    let mut edits = Edits::default();
    put_joints(file, text, wanted, own, &mut edits)?;
    edits.applied_to_part(file.bytes(), &text.whole)
}

/// The literal that says the configuration of an end.
pub(super) fn text_of<'s>(program: &'s RobotProgram, site: &'s TargetSite) -> Option<&'s PoseText> {
    match site {
        TargetSite::Literal(text) => Some(text),
        TargetSite::Declared { declaration, .. } => {
            Some(&program.declarations.get(*declaration)?.text)
        }
        TargetSite::Offset { literal, .. } => Some(literal),
        TargetSite::Partial(_)
        | TargetSite::Replaced(_)
        | TargetSite::Joints(_)
        | TargetSite::Fixed(_) => None,
    }
}

/// Position of a target's text; empty for partial, joint and fixed targets.
pub(super) fn span_of(site: &TargetSite) -> Range<usize> {
    match site {
        TargetSite::Literal(text) => text.whole.clone(),
        TargetSite::Declared { name, .. } => name.clone(),
        TargetSite::Offset { call, .. } => call.clone(),
        TargetSite::Replaced(text) => text.span.clone(),
        TargetSite::Partial(_) | TargetSite::Joints(_) | TargetSite::Fixed(_) => 0..0,
    }
}
