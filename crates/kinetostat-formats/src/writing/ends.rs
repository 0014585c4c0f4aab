//! The ends of motions and of their pieces, as literals and as declarations: edited where all uses agree, copied under free names where not.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use nalgebra::{Isometry3, UnitQuaternion};

use crate::model::motion::Motion;
use crate::model::program::RobotProgram;
use crate::model::site::{
    Declaration, DeclarationCopy, JointsText, OffsetAxes, PoseText, SpeedSite, TargetSite,
};
use crate::options::WriteOptions;
use crate::text::number::Width;
use crate::text::source::{Edits, SourceFile};
use crate::writing::piece::{NO_END, NO_JOINTS, NO_NAME, Reason};
use crate::writing::syntax::{Renamed, Syntax, Wanted, literal_of, put, put_pose};

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

/// Required poses of declarations, for each use, as the bytes of their literals.
#[derive(Debug, Default)]
pub(crate) struct Demands(BTreeMap<usize, Vec<Demand>>);

#[derive(Debug)]
struct Demand {
    /// Position of the name in a statement.
    file: usize,
    name: Range<usize>,
    literal: Vec<u8>,
}

impl Demands {
    /// A use, of an index of [`RobotProgram::declarations`], of a name in a file.
    pub(crate) fn demand(&mut self, of: usize, file: usize, name: Range<usize>, literal: Vec<u8>) {
        let demands = self.0.entry(of).or_default();
        demands.push(Demand {
            file,
            name,
            literal,
        });
    }

    /// Writes them; `None` where no name is free.
    pub(crate) fn write(
        self,
        program: &RobotProgram,
        syntax: &dyn Syntax,
        names: &mut Names,
        edits: &mut [Edits],
    ) -> Option<()> {
        let mut renamed = Vec::new();
        for (index, demands) in self.0 {
            let declaration = program.declarations.get(index)?;
            let home = declaration.text.file;
            let file = program.files.get(home)?;
            let original = file.part(&declaration.text.whole);
            let stays = declaration.keeps_value || demands.iter().any(|d| d.literal == original);
            let kept: &[u8] = match (stays, demands.first()) {
                (false, Some(first)) => &first.literal,
                _ => original,
            };
            if kept != original {
                edits[home].replace(declaration.text.whole.clone(), kept);
            }
            let mut new: BTreeMap<&[u8], Vec<u8>> = BTreeMap::new();
            let mut number = 2;
            for demand in demands.iter().filter(|demand| demand.literal != kept) {
                if !new.contains_key(demand.literal.as_slice()) {
                    let name = names.declare(
                        program,
                        syntax,
                        declaration,
                        &demand.literal,
                        &mut number,
                        edits,
                    )?;
                    new.insert(&demand.literal, name);
                }
                let name = new.get(demand.literal.as_slice())?;
                edits[demand.file].replace(demand.name.clone(), name.clone());
                renamed.push(Renamed {
                    home,
                    file: demand.file,
                    place: demand.name.clone(),
                    name: name.clone(),
                });
            }
        }
        if !renamed.is_empty() {
            syntax.renamed(program, &renamed, edits);
        }
        Some(())
    }
}

/// The names that are taken, once they are asked for.
#[derive(Debug, Default)]
pub(crate) struct Names(Option<BTreeSet<Vec<u8>>>);

impl Names {
    /// Declares a pose like another under a free name, and gives that name.
    pub(crate) fn declare(
        &mut self,
        program: &RobotProgram,
        syntax: &dyn Syntax,
        declaration: &Declaration,
        literal: &[u8],
        number: &mut usize,
        edits: &mut [Edits],
    ) -> Option<Vec<u8>> {
        let file = program.files.get(declaration.text.file)?;
        let taken = self.0.get_or_insert_with(|| syntax.names(program));
        let name = syntax.free_name(file.part(&declaration.name), number, taken)?;
        let at = syntax.copies_at(program, declaration);
        let text = further(program, declaration, &name, literal, at)?;
        edits[declaration.text.file].replace(at..at, text);
        Some(name)
    }
}

/// A further declaration on a line of its own, as it is put in at a place.
fn further(
    program: &RobotProgram,
    declaration: &Declaration,
    name: &[u8],
    literal: &[u8],
    at: usize,
) -> Option<Vec<u8>> {
    let file = program.files.get(declaration.text.file)?;
    let mut text = Vec::new();
    match &declaration.copy {
        DeclarationCopy::Statement => {
            let mut edits = Edits::default();
            edits.replace(declaration.name.clone(), name);
            edits.replace(declaration.text.whole.clone(), literal);
            text.extend(edits.applied_to_part(file.bytes(), &declaration.statement)?);
        }
        DeclarationCopy::Around {
            before,
            middle,
            after,
        } => {
            text.extend([before, name, middle.as_slice(), literal, after].concat());
        }
    }
    text.extend_from_slice(file.line_ending());
    // The text at the insertion point keeps its indentation.
    text.extend_from_slice(file.indentation_before(at));
    Some(text)
}
