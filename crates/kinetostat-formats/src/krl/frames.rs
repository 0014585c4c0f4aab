//! Tools and bases: what the text or the caller says they are.

use std::ops::Range;

use nalgebra::{Isometry3, Translation3};

use crate::krl::aggregate::{Position, literal_index, position_of};
use crate::krl::assigned_frames::{Assignment, Given, GivenEnd, Standing, of_element};
use crate::krl::lex::TokenFile;
use crate::krl::role::Role;
use crate::krl::symbols::Meaning;
use crate::krl::values::{Values, key};
use crate::model::frame::{Frame, FrameUse};
use crate::model::orientation::OrientationText;

/// Why an element is not the same everywhere.
fn changed() -> String {
    "the program gives it another value while it runs".to_owned()
}

/// The pose of six numbers.
pub(crate) fn isometry(numbers: [f64; 6]) -> Option<Isometry3<f64>> {
    let [x, y, z, a, b, c] = numbers;
    let rotation = OrientationText::Abc.rotation_of(&[a, b, c])?;
    Some(Isometry3::from_parts(Translation3::new(x, y, z), rotation))
}

fn whole(position: &Position) -> Option<Isometry3<f64>> {
    match position.values() {
        [Some(x), Some(y), Some(z), Some(a), Some(b), Some(c)] => isometry([x, y, z, a, b, c]),
        _ => None,
    }
}

impl Values<'_> {
    /// A frame that the caller states by its name.
    pub(crate) fn stated(&self, name: &str) -> Option<FrameUse> {
        let frame = *self.stated.get(&key(name))?;
        Some(FrameUse {
            name: name.to_owned(),
            frame: Frame::Known(frame),
        })
    }

    /// `TOOL_DATA[n]` or `BASE_DATA[n]`; number 0 is the flange or the world.
    pub(crate) fn numbered(&self, role: Role, number: u32, given: &Given) -> FrameUse {
        let name = format!("{}[{number}]", role.array());
        match self.standing(role, number, given) {
            Standing::One => {}
            Standing::Held(frame) => {
                let frame = Frame::Known(frame);
                return FrameUse { name, frame };
            }
            Standing::Apart(words) => {
                let known = self.known(role, number, given);
                let reason = known.err().unwrap_or_else(changed);
                return FrameUse {
                    name: format!("{name} {words}"),
                    frame: Frame::Unknown { reason },
                };
            }
        }
        if let Some(stated) = self.stated(&name) {
            return stated;
        }
        let frame = match self.known(role, number, given) {
            Ok(frame) => Frame::Known(frame),
            Err(reason) => Frame::Unknown { reason },
        };
        FrameUse { name, frame }
    }

    /// What an element is in the statement that is walked.
    fn standing(&self, role: Role, number: u32, given: &Given) -> Standing {
        let assigned = &self.symbols.frames_assigned;
        given.standing((role, number), assigned, |one| self.value(one))
    }

    /// The numbers of a statement that gives an element a value.
    fn value(&self, one: &Assignment) -> Option<Isometry3<f64>> {
        self.literal_frame(one.routine, one.value.as_ref()?)
    }

    /// Statements that give an element other numbers than the caller states for it: the element, their files and lines.
    pub(crate) fn contradicted(&self) -> Vec<(String, usize, usize)> {
        let mut found = Vec::new();
        for ((role, number), all) in &self.symbols.frames_assigned {
            let Some(number) = number else {
                continue;
            };
            let name = format!("{}[{number}]", role.array());
            let Some(stated) = self.stated.get(&name) else {
                continue;
            };
            for one in all {
                let differs = self.value(one).is_some_and(|own| {
                    let apart = own.inv_mul(stated);
                    // What stated numbers lose where they are written down.
                    apart.translation.vector.norm() > 1e-6 || apart.rotation.angle() > 1e-8
                });
                if differs {
                    let file = self.symbols.routines[one.routine].file;
                    found.push((name.clone(), file, one.line));
                }
            }
        }
        found
    }

    /// The same with an index that is no literal number.
    pub(crate) fn computed(&self, role: Role, index: &str) -> FrameUse {
        let name = format!("{}[{}]", role.array(), key(index));
        let reason = "its number is computed while the program runs".to_owned();
        self.stated(&name).unwrap_or(FrameUse {
            name,
            frame: Frame::Unknown { reason },
        })
    }

    /// What the program gives an element; none where it gives it nothing.
    fn given(
        &self,
        role: Role,
        number: u32,
        given: &Given,
    ) -> Option<Result<Isometry3<f64>, String>> {
        let all: Vec<_> = of_element(&self.symbols.frames_assigned, (role, number)).collect();
        let first = *all.first()?;
        if let Some(frame) = given.held((role, number), &all, |one| self.value(one)) {
            return Some(Ok(frame));
        }
        let line = first.line;
        let Some(frame) = self.value(first) else {
            return Some(Err(format!(
                "it is assigned while the program runs, in line {line}, and not in numbers"
            )));
        };
        if let Some(other) = (all.iter()).find(|own| self.value(own) != Some(frame)) {
            return Some(Err(format!(
                "it is assigned while the program runs, in lines {line} and {}, and not the same in both",
                other.line
            )));
        }
        Some(match given.numbers.contains_key(&(role, number)) {
            true => Ok(frame),
            false => Err(format!(
                "it is assigned while the program runs, in line {line}, and whether that ran before is not certain"
            )),
        })
    }

    fn known(&self, role: Role, number: u32, given: &Given) -> Result<Isometry3<f64>, String> {
        if number == 0 {
            return Ok(Isometry3::identity());
        }
        if let Some(found) = self.given(role, number, given) {
            return found;
        }
        let nowhere = || "none of these files states it: give $config.dat, or state it".to_owned();
        let datum = self.symbols.of_system(role.array()).ok_or_else(nowhere)?;
        let stated = datum.stated.get(&number).ok_or_else(nowhere)?;
        if let Some((_, line)) = datum.assigned.or(stated.assigned) {
            return Err(format!(
                "it is assigned while the program runs, in line {line}"
            ));
        }
        let position = position_of(&self.files[datum.file], &stated.value);
        let frame = position.ok().and_then(|position| whole(&position));
        frame.ok_or_else(|| "its numbers are not all stated".to_owned())
    }

    /// The frame that an expression is: sums of frames are one behind the other.
    pub(crate) fn frame(&self, routine: usize, tokens: &Range<usize>, given: &Given) -> FrameUse {
        let file = self.file(routine);
        let name = key(&file.text(tokens));
        for role in [Role::Tool, Role::Base] {
            if let Some(number) = self.number_in(file, role, tokens) {
                return self.numbered(role, number, given);
            }
        }
        if let Some(stated) = self.stated(&name) {
            return stated;
        }
        let mut frame = Isometry3::identity();
        let mut at = tokens.start;
        while at < tokens.end {
            let end = file.find(at..tokens.end, b':').unwrap_or(tokens.end);
            match self.part(routine, &(at..end), given) {
                Ok(part) => frame *= part,
                Err(reason) => {
                    return FrameUse {
                        name: self.named_apart(routine, tokens, name),
                        frame: Frame::Unknown { reason },
                    };
                }
            }
            at = end + 1;
        }
        FrameUse {
            name,
            frame: Frame::Known(frame),
        }
    }

    /// A frame in numbers, or a datum with one value.
    pub(crate) fn literal_frame(
        &self,
        routine: usize,
        tokens: &Range<usize>,
    ) -> Option<Isometry3<f64>> {
        let file = self.file(routine);
        if file.is(tokens.start, b'{') {
            return whole(&position_of(file, tokens).ok()?);
        }
        if Role::of_array(&file.name(tokens.start)?).is_some() {
            return None;
        }
        let (datum, stated) = self.datum(routine, tokens).ok()?;
        whole(&position_of(&self.files[datum.file], &stated.value).ok()?)
    }

    /// The datum that a name alone means, where statements alone give it its values.
    pub(crate) fn own_datum(&self, routine: usize, tokens: &Range<usize>) -> Option<usize> {
        let name = self.file(routine).name(tokens.start)?;
        let Some(Meaning::Datum(index)) = self.symbols.meaning(routine, &name) else {
            return None;
        };
        let datum = self.symbols.data.get(index)?;
        let is_own = !datum.is_global && !datum.is_changed_by_calls;
        (tokens.len() == 1 && is_own).then_some(index)
    }

    /// What statements gave a datum before, in numbers and for certain: those of the same routine, or all that there are.
    pub(crate) fn assigned_end<'g>(
        &self,
        routine: usize,
        tokens: &Range<usize>,
        given: &'g Given,
    ) -> Option<&'g GivenEnd> {
        let index = self.own_datum(routine, tokens)?;
        let end = given.ends.get(&index)?.as_ref()?;
        let is_here = end.routine == routine && given.is_certain;
        (is_here || end.count == self.symbols.data[index].assignments).then_some(end)
    }

    /// What a datum is behind a statement that gives it a value (`P1={X 1,Y 2}`, `P1=P2`), or a member of it one (`P1.X=10`).
    pub(crate) fn given_end(
        &self,
        (routine, datum): (usize, usize),
        (tokens, equals): (&Range<usize>, usize),
        given: &Given,
    ) -> Option<GivenEnd> {
        let file = self.file(routine);
        let value = equals + 1..tokens.end;
        let before = given.ends.get(&datum).cloned().flatten();
        let count = 1 + before.as_ref().map_or(0, |before| before.count);
        let position = if file.is(tokens.start + 1, b'.') && equals == tokens.start + 3 {
            let mut position = match given.ends.contains_key(&datum) {
                true => before.filter(|before| before.routine == routine)?.position,
                false => self.kept_members(datum)?,
            };
            let member = file.name(equals - 1)?;
            // What is written of S and T stands beside their names.
            let is_number = !member.is("S") && !member.is("T");
            position
                .set(file, &member, &value)
                .ok()
                .filter(|()| is_number)?;
            position
        } else if equals != tokens.start + 1 {
            return None;
        } else if file.is(value.start, b'{') {
            position_of(file, &value).ok()?
        } else if let Some(other) = self.assigned_end(routine, &value, given) {
            other.position.clone()
        } else {
            let (other, stated) = self.datum(routine, &value).ok()?;
            position_of(&self.files[other.file], &stated.value).ok()?
        };
        Some(GivenEnd {
            routine,
            line: given.at.1,
            count,
            position,
        })
    }

    /// What is stated of a datum without the members that statements change: a controller keeps what the last run left there.
    fn kept_members(&self, datum: usize) -> Option<Position> {
        let datum = &self.symbols.data[datum];
        let stated = match datum.stated.get(&0) {
            Some(stated) if datum.parts_assigned.len() == datum.assignments => {
                position_of(&self.files[datum.file], &stated.value).ok()?
            }
            _ => Position::default(),
        };
        Some(stated.without(&datum.parts_assigned))
    }

    /// The name of a frame that is not known: with its line, where a datum gets several values and each use may be another frame.
    fn named_apart(&self, routine: usize, tokens: &Range<usize>, name: String) -> String {
        let file = self.file(routine);
        let all = tokens.clone().filter_map(|at| file.name(at));
        let mut arrays = all.clone().filter_map(|name| Role::of_array(&name));
        let is_array = arrays.any(|role| {
            let assigned = self.symbols.frames_assigned.keys();
            assigned.clone().any(|(of, _)| *of == role)
        });
        let mut data = all.filter_map(|name| match self.symbols.meaning(routine, &name)? {
            Meaning::Datum(index) => self.symbols.data.get(index),
            Meaning::Parameter => None,
        });
        match is_array || data.any(|datum| datum.assignments > 1) {
            true => {
                let line = file.source.line_of(file.span(tokens).start);
                format!("{name} of line {line}")
            }
            false => name,
        }
    }

    /// The number in `TOOL_DATA[3]`.
    fn number_in(&self, file: &TokenFile<'_>, role: Role, tokens: &Range<usize>) -> Option<u32> {
        let is_array = file.name(tokens.start)?.is(role.array());
        (is_array && tokens.len() > 1).then(|| literal_index(file, tokens.start + 1..tokens.end))?
    }

    fn part(
        &self,
        routine: usize,
        tokens: &Range<usize>,
        given: &Given,
    ) -> Result<Isometry3<f64>, String> {
        let file = self.file(routine);
        let computed = || "it is computed while the program runs".to_owned();
        if file.is(tokens.start, b'{') {
            let position = position_of(file, tokens).map_err(str::to_owned)?;
            return whole(&position).ok_or_else(|| "its numbers are not all stated".to_owned());
        }
        let name = file.name(tokens.start).ok_or_else(computed)?;
        if tokens.len() == 1 && (name.is("$NULLFRAME") || name.is("$WORLD")) {
            return Ok(Isometry3::identity());
        }
        for role in [Role::Tool, Role::Base] {
            if let Some(number) = self.number_in(file, role, tokens) {
                return match self.numbered(role, number, given).frame {
                    Frame::Known(frame) => Ok(frame),
                    Frame::Unknown { reason } => Err(reason),
                };
            }
        }
        if let Some(stated) = self.stated.get(&key(&file.text(tokens))) {
            return Ok(*stated);
        }
        if let Some(end) = self.assigned_end(routine, tokens, given) {
            return whole(&end.position).ok_or_else(|| "its numbers are not all stated".to_owned());
        }
        let (datum, stated) = self.datum(routine, tokens).map_err(|(reason, _)| reason)?;
        let position =
            position_of(&self.files[datum.file], &stated.value).map_err(str::to_owned)?;
        whole(&position).ok_or_else(|| "its numbers are not all stated".to_owned())
    }
}
