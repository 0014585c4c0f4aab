//! Ends of motions and frames, by the expressions that state them as poses, and the declared targets whose numbers a correction changes.

use std::ops::Range;

use nalgebra::{Isometry3, Translation3, Vector3};

use crate::interpreter::expression::{Expression, Node};
use crate::interpreter::run::{Dialect, Reason, Run};
use crate::interpreter::tree::DatumNode;
use crate::interpreter::value::{Datum, Value};
use crate::model::motion::{Frame, FrameUse, Motion, MotionKind, Runs, Speed, Zone};
use crate::model::orientation::OrientationText;
use crate::model::site::{
    Declaration, DeclarationCopy, MotionSite, PoseText, ReplacedText, TargetSite,
};
use crate::model::target::{Configuration, PoseTarget, Target};
use crate::options::UnknownTargets;
use crate::text::Name;
use crate::text::number::{NumberText, Width};

/// Form of poses in a language: six numbers or more, of which the first three are the position.
pub(crate) struct PoseForm {
    pub unit_mm: f64,
    pub orientation: OrientationText,
    /// Text around a copied declaration.
    pub around: Around,
    /// Remedy of an unknown end.
    pub remedy: &'static str,
}

impl PoseForm {
    /// The frame of a pose, mm.
    pub(crate) fn frame_of(&self, pose: &Datum) -> Option<Isometry3<f64>> {
        let members = pose.members().iter().map(|(_, part)| part);
        let numbers = members.chain(pose.parts()).map(Datum::as_number);
        let numbers: Vec<f64> = numbers.collect::<Option<_>>()?;
        let (place, turn) = numbers.split_at_checked(3)?;
        let place = Translation3::from(self.unit_mm * Vector3::from_column_slice(place));
        Some(Isometry3::from_parts(
            place,
            self.orientation.rotation_of(turn)?,
        ))
    }

    /// The pose of a frame, with members of these names.
    pub(crate) fn pose_of(&self, frame: &Isometry3<f64>, names: &[&str]) -> Datum {
        let place = frame
            .translation
            .vector
            .iter()
            .map(|part| part / self.unit_mm);
        let numbers = place.chain(self.orientation.numbers_of(&frame.rotation, &[]));
        let names = names.iter().filter_map(|name| Name::of(name.as_bytes()));
        let members: Vec<(Name, Datum)> = names.zip(numbers.map(Datum::number)).collect();
        Datum::of(Value::Members(members.into()))
    }
}

/// Positions of the numbers of a pose in the text.
fn text_of(form: &PoseForm, value: &Datum) -> Option<PoseText> {
    let whole = value.literal?;
    let (file, span) = (whole.file, whole.span());
    let members = value.members().iter().map(|(_, part)| part);
    let parts = members.chain(value.parts());
    let numbers = parts.map(|part| part.number_in(file, &span));
    let mut position: Vec<NumberText> = numbers.collect::<Option<_>>()?;
    let orientation = position.split_off(3.min(position.len()));
    Some(PoseText {
        file,
        whole: span,
        position: position.try_into().ok()?,
        unit_mm: form.unit_mm,
        orientation,
        convention: form.orientation,
        external: Vec::new(),
        width: Width::Free,
    })
}

impl<D: Dialect> Run<'_, '_, D> {
    /// The end that an expression of this value is, and where its numbers stand.
    pub(crate) fn pose_end(
        &mut self,
        form: &PoseForm,
        expression: &Expression,
        value: &Datum,
    ) -> Result<(Target, TargetSite), Reason> {
        let Some(pose) = form.frame_of(value) else {
            let unknown = value.unknown_reason().map(ToString::to_string);
            let shown = || self.file().text(&expression.tokens);
            let reason = unknown.unwrap_or_else(|| format!("`{}` is no pose", shown()));
            if self.options.unknown_targets == UnknownTargets::LeftAsWritten {
                let site = TargetSite::Fixed("its end is not known from the text");
                return Ok((Target::Unknown { reason }, site));
            }
            return Err((reason, form.remedy));
        };
        let pose = PoseTarget {
            position_mm: pose.translation.vector,
            orientation: pose.rotation,
            configuration: Configuration::default(),
            external: Vec::new(),
        };
        let text = text_of(form, value);
        let found = match &expression.node {
            Node::Members(_) | Node::List(_) => text.map(TargetSite::Literal),
            _ => text.and_then(|text| self.declared(expression, text, &pose, &form.around)),
        };
        let site = found.unwrap_or_else(|| {
            TargetSite::Replaced(Box::new(ReplacedText {
                span: self.file().span(&expression.tokens),
                pose: pose.clone(),
                parts: None,
            }))
        });
        Ok((Target::Pose(pose), site))
    }

    /// A motion of a statement, with tool and work object, that stops at its end, without a speed.
    pub(crate) fn made_motion(
        &self,
        tokens: &Range<usize>,
        kind: MotionKind,
        target: Target,
        site: MotionSite,
        [tool, work_object]: [FrameUse; 2],
    ) -> Motion {
        let file = self.file();
        let span = file.span(tokens);
        Motion {
            file: file.index,
            line: file.source.line_of(span.start),
            span,
            kind,
            target,
            speed: Speed::default(),
            zone: Zone::Exact,
            tool,
            work_object,
            runs: Runs::Once,
            follows: None,
            site,
        }
    }

    /// The length of the straight way from where the tool is to the end of a motion.
    pub(crate) fn way_mm(&self, motion: &Motion) -> Option<f64> {
        let start = self.motions.get(self.here?)?;
        let is_same = start.tool == motion.tool;
        let [start, end] = [start.base_pose()?, motion.base_pose()?];
        is_same.then(|| (end.translation.vector - start.translation.vector).norm())
    }

    /// The frame that an expression names: as the caller states it, or as its value is read.
    pub(crate) fn frame_use(&mut self, form: &PoseForm, expression: &Expression) -> FrameUse {
        let name = self.file().text(&expression.tokens);
        let stated = self.options.frames.get(&name).copied();
        let value = self.value(expression);
        let frame = match (
            stated.or_else(|| form.frame_of(&value)),
            value.unknown_reason(),
        ) {
            (Some(frame), _) => Frame::Known(frame),
            (None, Some(reason)) => Frame::Unknown {
                reason: format!("{reason}; state it under [robot.frames]"),
            },
            (None, None) => Frame::Unknown {
                reason: "it is no pose".to_owned(),
            },
        };
        FrameUse { name, frame }
    }
}

/// Texts around the name and the value of a further declaration.
pub(crate) struct Around {
    pub before: fn(&DatumNode) -> String,
    pub middle: &'static [u8],
    pub after: &'static [u8],
}

impl<D: Dialect> Run<'_, '_, D> {
    /// The declaration of a name or of an element of an array, where its first value, of which this is the text, is what the
    /// motion ends at.
    pub(crate) fn declared(
        &mut self,
        expression: &Expression,
        text: PoseText,
        pose: &PoseTarget,
        around: &Around,
    ) -> Option<TargetSite> {
        let file = self.file();
        let name = match &expression.node {
            Node::Word(name) => name,
            Node::Element(of, _) => match &of.node {
                Node::Word(name) => name,
                _ => return None,
            },
            _ => return None,
        };
        let index = self.datum_of(self.root(name)?)?;
        let datum = &self.symbols.data[index];
        let home = &self.files[datum.file];
        let is_in = |tokens: &Range<usize>| {
            let Range { start, end } = home.span(tokens);
            text.file == datum.file && start <= text.whole.start && text.whole.end <= end
        };
        let preset = datum.elements.values().find(|preset| is_in(&preset.tokens));
        let (statement, name_at) = match preset {
            Some(preset) => (&preset.tokens, preset.name_at),
            None if is_in(&datum.node.tokens) => (&datum.node.tokens, datum.node.name_at),
            None => return None,
        };
        let span = file.span(&expression.tokens);
        let ends = &mut self.targets.ends;
        ends.insert((file.index, span.start), *name);
        let key = (text.file, text.whole.start);
        if let Some(declaration) = self.targets.known.get(&key) {
            let declaration = *declaration;
            return Some(TargetSite::Declared {
                declaration,
                name: span,
            });
        }
        let is_whole = matches!(expression.node, Node::Word(_)) && datum.node.is_alone;
        let named = home.span(&(name_at..name_at + 1));
        let copy = match is_whole && preset.is_none() {
            true => DeclarationCopy::Statement,
            false => DeclarationCopy::Around {
                before: (around.before)(datum.node).into_bytes(),
                middle: around.middle.to_vec(),
                after: around.after.to_vec(),
            },
        };
        let declaration = self.targets.declarations.len();
        self.targets.known.insert(key, declaration);
        self.targets.names.push(*name);
        self.targets.declarations.push(Declaration {
            statement: home.span(statement),
            name: named,
            text,
            pose: pose.clone(),
            keeps_value: false,
            copy,
        });
        Some(TargetSite::Declared {
            declaration,
            name: span,
        })
    }
}
