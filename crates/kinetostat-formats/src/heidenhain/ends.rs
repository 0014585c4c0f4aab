//! End point of a path block and the way to it: Cartesian, or polar about a pole.

use kinetostat_program::last_digit_mm;
use nalgebra::Vector2;

use crate::heidenhain::arcs::{AGAIN, Arc, Plane, Turned, about, by_radius, polar, tangential};
use crate::heidenhain::path_words::{Coordinate, PathWords};
use crate::heidenhain::state::{Pole, State};
use crate::heidenhain::words::Word;

/// End of a block in the programmed axes, mm, and the way to it.
pub(crate) struct Went {
    pub end: [Option<f64>; 3],
    pub shape: Shape,
    /// The plane of its arc.
    pub plane: Plane,
    pub arc: Option<Arc>,
}

/// Largest angle of a helix: 15 turns.
const MOST_DEGREES: f64 = 5400.0;

/// Reason and remedy of a refused block.
pub(crate) type Reason = (String, &'static str);

const STATE_PLACE: &str = "state X, Y and Z once before it, without M91";

/// Form of a motion's path, for the writer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shape {
    /// Cartesian: X, Y and Z.
    Straight,
    /// Polar: radius and angle; `whole` if both are stated, so that the end does not depend on the start.
    Polar { whole: bool },
    /// Arc about a pole or by a radius.
    Arc,
    /// An arc that begins in the direction of before.
    Tangential,
    /// The block stays as it is written.
    Unknown,
}

/// Input for the end of a block.
pub(crate) struct Ends<'s> {
    pub state: &'s mut State,
    pub unit_mm: f64,
}

impl Ends<'_> {
    /// The end of a path block and its way, in the programmed axes.
    pub(crate) fn of(&mut self, words: &[Word], parsed: &PathWords) -> Result<Went, Reason> {
        let unit = self.unit_mm;
        let kind = words[0].letters;
        let along_z = kind.is("L")
            && parsed
                .places
                .iter()
                .all(|at| words[*at].is("Z") || words[*at].is("IZ"));
        if !along_z {
            self.state.settle();
        }
        let mut end = self.state.place;
        for axis in 0..3 {
            if let Some(Coordinate { value, step, .. }) = parsed.axes[axis] {
                end[axis] = match step {
                    true => end[axis].map(|at| at + value * unit),
                    false => Some(value * unit),
                };
            }
        }
        let is_polar = matches!(kind.letters(), b"LP" | b"CP" | b"CTP");
        if !is_polar && (parsed.radius.is_some() || parsed.angle.is_some()) {
            return Err((
                "polar words stand in a block without P".to_owned(),
                "write LP or CP",
            ));
        }
        let working = self.state.plane;
        let by_pole = is_polar || kind.is("C");
        let pole = self.state.pole.filter(|_| by_pole);
        let plane = pole.map_or(working, |pole| pole.plane);
        if kind.is("C") && plane != working && parsed.axes[plane.0].is_some() {
            return Err((
                "the circle states an axis across the plane of its CC".to_owned(),
                "state CC by the two axes of the circle before it",
            ));
        }
        let whole = parsed.radius.is_some_and(|c| !c.step) && parsed.angle.is_some_and(|c| !c.step);
        let mut turned = None;
        if is_polar {
            let (place, angle) = self.polar_end(kind.is("CP"), parsed)?;
            let [u, v] = plane.axes();
            (end[u], end[v]) = (Some(place.x), Some(place.y));
            turned = Some(angle);
        }
        let (shape, arc) = match kind.letters() {
            b"L" | b"LN" => (Shape::Straight, None),
            b"LP" => (Shape::Polar { whole }, None),
            b"C" | b"CP" | b"CR" => (
                Shape::Arc,
                self.circle(kind.is("CR"), parsed, plane, &end, turned)?,
            ),
            b"CT" | b"CTP" => {
                let (from, to) = (self.state.in_plane(plane), plane.known(end));
                let (Some(from), Some(to)) = (from, to) else {
                    return Err(("where its arc begins is not known".to_owned(), STATE_PLACE));
                };
                let way = self.state.direction.map(|way| plane.flat(&way));
                let Some(direction) = way.and_then(|way| way.try_normalize(1e-9)) else {
                    return Err((
                        "the direction in which the block before ends is not known".to_owned(),
                        "write the arc with CC and C",
                    ));
                };
                let arc = tangential(&from, &to, &direction)
                    .map_err(|reason| (reason, "let the CAM system write the arc with CC and C"))?;
                (Shape::Tangential, arc)
            }
            _ => {
                return Err((
                    "coordinates stand in a block without L".to_owned(),
                    "write L before them",
                ));
            }
        };
        Ok(Went {
            end,
            shape,
            plane,
            arc,
        })
    }

    /// A polar end in the plane of the pole, and its angle or the angle turned, degrees.
    fn polar_end(
        &mut self,
        is_circle: bool,
        parsed: &PathWords,
    ) -> Result<(Vector2<f64>, f64), Reason> {
        let Pole {
            plane, at: pole, ..
        } = self.state.pole.ok_or((
            "the pole is not known".to_owned(),
            "state it before: CC X.. Y..",
        ))?;
        let arm = self.state.in_plane(plane).map(|here| here - pole);
        let unknown = || ("where its way begins is not known".to_owned(), STATE_PLACE);
        let now = || arm.map(|arm| arm.y.atan2(arm.x).to_degrees());
        let unit = self.unit_mm;
        let radius = match (parsed.radius, is_circle) {
            (
                Some(Coordinate {
                    value, step: false, ..
                }),
                false,
            ) => value * unit,
            (
                Some(Coordinate {
                    value, step: true, ..
                }),
                false,
            ) => arm.ok_or_else(unknown)?.norm() + value * unit,
            (Some(_), true) => {
                return Err((
                    "CP states a radius".to_owned(),
                    "take PR out: the tool is on the circle",
                ));
            }
            (None, _) => {
                let here = arm.ok_or_else(unknown)?.norm();
                let last = self.state.radius_mm.unwrap_or(here);
                if (here - last).abs() > 0.02 && !is_circle {
                    return Err((
                        "the polar radius is not stated, and the tool is not at the last one"
                            .to_owned(),
                        "state PR",
                    ));
                }
                match is_circle {
                    true => here,
                    false => last,
                }
            }
        };
        let (angle, turned) = match parsed.angle {
            Some(Coordinate {
                value, step: false, ..
            }) => (value, value),
            Some(Coordinate {
                value, step: true, ..
            }) => (now().ok_or_else(unknown)? + value, value),
            None if is_circle => {
                return Err(("the arc has no angle".to_owned(), "state PA or IPA"));
            }
            None => (now().ok_or_else(unknown)?, 0.0),
        };
        if !(radius.is_finite() && angle.abs() < 1e6) {
            return Err(("the angle is too large".to_owned(), "mend it"));
        }
        if !is_circle {
            self.state.radius_mm = Some(radius);
        }
        Ok((polar(&pole, radius, angle), turned))
    }

    fn circle(
        &mut self,
        by_size: bool,
        parsed: &PathWords,
        plane: Plane,
        end: &[Option<f64>; 3],
        turned: Option<f64>,
    ) -> Result<Option<Arc>, Reason> {
        let sense = parsed.sense.ok_or((
            "the sense of the circle is not stated".to_owned(),
            "state DR+ or DR-",
        ))?;
        let (from, to) = (self.state.in_plane(plane), plane.known(*end));
        let (Some(from), Some(to)) = (from, to) else {
            return Err(("where its arc begins is not known".to_owned(), STATE_PLACE));
        };
        if by_size {
            let size = parsed
                .circle
                .ok_or(("the circle has no radius".to_owned(), "state R"))?;
            let arc = by_radius(&from, &to, size * self.unit_mm, sense);
            return arc.map(Some).map_err(|reason| (reason, AGAIN));
        }
        let pole = self.state.pole.map(|pole| pole.at).ok_or((
            "the centre of the circle is not known".to_owned(),
            "state it before: CC X.. Y..",
        ))?;
        let turned = match (parsed.angle, turned) {
            (Some(Coordinate { step: true, .. }), Some(by)) => {
                if by * sense <= 0.0 || by.abs() > MOST_DEGREES {
                    return Err((
                        "its angle and its sense do not fit, or it is more than 15 turns"
                            .to_owned(),
                        "give IPA the sign of DR",
                    ));
                }
                Turned::By(by.to_radians())
            }
            _ => {
                let stated = parsed.axes.iter().flatten();
                let values: Vec<f64> = stated.map(|coordinate| coordinate.value).collect();
                let digit_mm = last_digit_mm(&values, self.unit_mm);
                Turned::ToEnd { sense, digit_mm }
            }
        };
        about(pole, &from, &to, turned).map(Some)
    }
}
