//! A generated program, and where it goes.

use nalgebra::Vector3;

/// A motion as the generator meant it.
#[derive(Debug, Clone)]
pub enum Truth {
    Straight {
        start: [f64; 3],
        end: [f64; 3],
    },
    Arc {
        axes: [usize; 3],
        centre: [f64; 2],
        start: [f64; 3],
        end: [f64; 3],
        sweep: f64,
    },
}

impl Truth {
    pub fn point(&self, share: f64) -> Vector3<f64> {
        match self {
            Truth::Straight { start, end } => {
                Vector3::from(*start).lerp(&Vector3::from(*end), share)
            }
            Truth::Arc {
                axes,
                centre,
                start,
                end,
                sweep,
            } => {
                let (du, dv) = (start[axes[0]] - centre[0], start[axes[1]] - centre[1]);
                let angle = dv.atan2(du) + sweep * share;
                let radius = du.hypot(dv);
                let mut point = Vector3::zeros();
                point[axes[0]] = centre[0] + radius * angle.cos();
                point[axes[1]] = centre[1] + radius * angle.sin();
                point[axes[2]] = start[axes[2]] + (end[axes[2]] - start[axes[2]]) * share;
                point
            }
        }
    }
}

/// A generated program.
#[derive(Debug)]
pub struct Generated {
    pub text: String,
    pub truths: Vec<Truth>,
    pub facts: Vec<Fact>,
}

/// What the text says about a motion.
#[derive(Debug, Clone, Copy)]
pub struct Fact {
    /// Axes whose place the text says, before and after.
    pub known: [[bool; 3]; 2],
    /// Axes that the block moves.
    pub named: [bool; 3],
    /// To a place of the machine.
    pub machine: bool,
}
