//! Reasons for which no turns of the tool are chosen.

use std::fmt;

use kinetostat::number::counted;
use kinetostat::{Mechanism, MotionKind};

/// Reason for which no turns of the tool are chosen.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TurnError {
    /// A number or a path that no sensible task has.
    #[error("{what}")]
    Input {
        /// Value found, and remedy.
        what: String,
    },
    /// The machine has no free turn about the axis of its tool, or not one that is understood.
    #[error("{what}")]
    NoFreedom {
        /// Machine found, and machine needed.
        what: String,
    },
    /// More stations and postures than may be kept.
    #[error(
        "{what}; {most} may be kept. Take stations that are farther apart (station_mm), a larger step or a narrower band of turns, or \
         allow more (most_postures)"
    )]
    TooMany {
        /// Quantity of which there is too much.
        what: String,
        /// Maximum number allowed.
        most: usize,
    },
    /// The stiffness at a place has no answer.
    #[error("line {line}: {message}")]
    Point {
        /// Line of the program, from 1.
        line: usize,
        /// The core's error.
        message: String,
    },
    /// The arm cannot follow the path with any sequence of turns.
    #[error("{0}")]
    NoWay(Box<NoWay>),
}

impl TurnError {
    pub(crate) fn no_freedom(mechanism: &Mechanism) -> Self {
        let needed = "the free turn of a round tool is chosen for an arm of six turning joints in one chain, 2 and 3 parallel and square \
                      to 1, and 4, 5 and 6 square to their neighbours through one point";
        let found = match mechanism.limbs() {
            [limb] => {
                let actuators = limb.nominal.actuators();
                let sliding = actuators.iter().filter(|a| a.kind == MotionKind::Prismatic);
                match (actuators.len(), sliding.count()) {
                    (6, 0) => "its six joints are arranged otherwise".to_owned(),
                    (joints, 0) => format!("it has {}", counted(joints, "joint")),
                    (joints, slides) => {
                        format!(
                            "it has {}, of which {slides} slide",
                            counted(joints, "joint")
                        )
                    }
                }
            }
            limbs => format!("its tool is carried by {} limbs", limbs.len()),
        };
        let name = mechanism.name();
        Self::NoFreedom {
            what: format!(
                "machine '{name}': {needed}; {found}, so the tool keeps the turn that the program states"
            ),
        }
    }
}

/// Reason for which no sequence of turns passes a place.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum TurnBarrier {
    /// The arm does not reach the place.
    OutOfReach,
    /// A joint would be outside its limits, or nearer to one than allowed.
    Limit {
        /// Name of the joint.
        joint: String,
    },
    /// The arm would be singular, or nearer to it than allowed.
    Singular,
    /// Only another configuration can continue: the arm would have to flip.
    Flip,
    /// A joint would have to turn too far at once.
    JointStep {
        /// Name of the joint.
        joint: String,
    },
    /// The tool would have to be turned faster than allowed.
    Rate,
}

impl fmt::Display for TurnBarrier {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutOfReach => write!(f, "the place is out of reach"),
            Self::Limit { joint } => write!(f, "'{joint}' meets its limit"),
            Self::Singular => write!(f, "the arm comes too near to a singular posture"),
            Self::Flip => write!(
                f,
                "only another configuration goes on, and the arm would have to flip"
            ),
            Self::JointStep { joint } => {
                write!(f, "'{joint}' would have to turn too far at once")
            }
            Self::Rate => write!(f, "the tool would have to be turned faster than allowed"),
        }
    }
}

/// A part of a path that the arm can follow with turns of the band.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct TurnPart {
    /// First line, from 1.
    pub from_line: usize,
    /// Last line.
    pub to_line: usize,
    /// Way along the path where it begins, mm.
    pub from_mm: f64,
    /// Way where it ends, mm.
    pub to_mm: f64,
    /// The turn at its first station, deg.
    pub turn_deg: f64,
    /// The configuration of the arm along it, by its number.
    pub configuration: u8,
}

/// Place at which every sequence of turns ends, the reasons, and remedies.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct NoWay {
    /// Line of the program, from 1.
    pub line: usize,
    /// Program coordinates, mm.
    pub position_mm: [f64; 3],
    /// Way along the path, mm.
    pub way_mm: f64,
    /// Barriers, the most frequent first, with the share of the turns and configurations that each ends there.
    pub barriers: Vec<(TurnBarrier, f64)>,
    /// A band of turns with which there is a way, from and to, deg: looked for on the whole circle.
    pub wider_band_deg: Option<[f64; 2]>,
    /// A configuration with which there is a way, by its number, where the task asks for another one.
    pub other_configuration: Option<u8>,
    /// Parts into which the program can be divided, each with turns of its own; empty where a place has no posture at all.
    pub parts: Vec<TurnPart>,
    /// Longest part that each constant turn of the band covers; the longest one first.
    pub constant: Vec<TurnPart>,
}

impl NoWay {
    /// Remedy, in a sentence without a full stop.
    fn helps(&self) -> String {
        if let Some(number) = self.other_configuration {
            return format!("With configuration {number} there is a way (bounds.configuration)");
        }
        if let Some([from, to]) = self.wider_band_deg {
            return format!(
                "With turns from {from:.0} to {to:.0} deg there is a way: widen the band"
            );
        }
        if self.parts.len() > 1 {
            let lines = self.parts[1..]
                .iter()
                .map(|part| part.from_line.to_string());
            let lines: Vec<String> = lines.collect();
            let lines = match lines.len() > 10 {
                true => format!("{} and {} more", lines[..10].join(", "), lines.len() - 10),
                false => lines.join(", "),
            };
            return format!(
                "Divided before line {lines} the program has a way in each of its parts, with the tool lifted and the arm taken to another \
                 posture between them"
            );
        }
        "No turn of the tool and no configuration goes through there: move the part (part_origin_mm), or tilt the tool".to_owned()
    }
}

impl fmt::Display for NoWay {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.position_mm;
        let why: Vec<String> = self
            .barriers
            .iter()
            .map(|(barrier, share)| format!("{barrier} ({:.0} %)", 100.0 * share))
            .collect();
        let why = match why.is_empty() {
            true => "no posture goes on".to_owned(),
            false => why.join(", "),
        };
        write!(
            f,
            "line {}: at X{x:.4} Y{y:.4} Z{z:.4} mm no turn of the tool about its own axis lets the arm go on: {why}. {}",
            self.line,
            self.helps()
        )?;
        if let Some(best) = self.constant.first() {
            write!(
                f,
                ". A constant turn of {:.0} deg covers lines {} to {}, the most of all",
                best.turn_deg, best.from_line, best.to_line
            )?;
        }
        Ok(())
    }
}
