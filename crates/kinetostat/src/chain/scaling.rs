//! Units in which all unknowns of a chain are comparable, and sizes of its steps and motions.

use crate::model::chain::{Chain, Role};
use crate::number::{larger, smaller};
use crate::spatial::MotionKind;

/// Root of the sum of squares without a part of it.
pub(crate) fn beyond(whole: f64, part: f64) -> f64 {
    ((whole - part) * (whole + part)).max(0.0).sqrt()
}

/// Ratio of the stiffest to the softest spring from which pivots of dense matrices are lost among the numbers that they
/// come from; a sweep takes spring by spring.
const DISPARATE: f64 = 1e7;

/// True if the springs' stiffnesses (rotations at the natural length) differ by more than [`DISPARATE`].
pub(crate) fn disparate(scales: &[f64], chain: &Chain) -> bool {
    let length = chain.scale().length;
    let own = chain.coordinates().iter().zip(&scales[6..]);
    let stiffnesses = own
        .filter(|(c, _)| c.role == Role::Spring)
        .map(|(c, factor)| match c.kind {
            MotionKind::Prismatic => factor.powi(-2),
            MotionKind::Revolute => (factor * length).powi(-2),
        });
    let (least, most) = stiffnesses.fold((f64::INFINITY, 0.0_f64), |(least, most), k| {
        (smaller(least, k), larger(most, k))
    });
    most > DISPARATE * least
}

/// Scales that make all unknowns of a bordered system comparable: six for the wrench, `n` for
/// the coordinates; each has the unit of its unknown per square root of energy.
pub fn scales_of(chain: &Chain, posture: &[f64]) -> Vec<f64> {
    let scale = chain.scale();
    let root = scale.stiffness.sqrt();
    let mut scales = Vec::with_capacity(6 + chain.coordinate_count());
    scales.extend([root; 3]);
    scales.extend([root * scale.length; 3]);
    let springs: Vec<f64> = {
        let mut stiffness = vec![0.0; chain.coordinate_count()];
        for block in chain.springs() {
            let k = block.stiffness_at(posture);
            for i in 0..block.len() {
                stiffness[block.first + i] = k[(i, i)];
            }
        }
        stiffness
    };
    scales.extend(
        chain
            .coordinates()
            .iter()
            .zip(springs)
            .map(|(c, k)| match (c.role, c.kind) {
                (Role::Spring, _) => 1.0 / k.sqrt(),
                (Role::Passive, MotionKind::Prismatic) => 1.0 / root,
                (Role::Passive, MotionKind::Revolute) => 1.0 / (root * scale.length),
            }),
    );
    scales
}

/// Largest step that keeps rotations of joints below half a radian and slides below half the
/// natural length: beyond that the linearisation says nothing.
pub(crate) fn step_limit(chain: &Chain, step: impl Iterator<Item = f64>) -> f64 {
    let slide = 0.5 * chain.scale().length;
    chain
        .coordinates()
        .iter()
        .zip(step)
        .fold(1.0_f64, |limit, (c, dx)| {
            let most = match c.kind {
                MotionKind::Revolute => 0.5,
                MotionKind::Prismatic => slide,
            };
            limit.min(most / dx.abs().max(1e-300))
        })
}

/// Loads smaller than this share of the natural ones (a deflection by the whole length) are taken
/// as that large where a residual is stated relative to them.
pub(crate) const LEAST_LOAD: f64 = 1e-9;

/// Unit of scaled residuals: square root of the energy of a deflection by the natural length.
pub(crate) fn natural(chain: &Chain) -> f64 {
    chain.scale().stiffness.sqrt() * chain.scale().length
}

/// Sum of the turns (rad) and slides (natural lengths) of a chain's coordinates.
pub(crate) fn gone(chain: &Chain, from: &[f64], to: &[f64]) -> f64 {
    let length = chain.scale().length;
    let kinds = chain.coordinates().iter().map(|c| c.kind);
    let moved = kinds.zip(from.iter().zip(to));
    let moved = moved.map(|(kind, (here, there))| match kind {
        MotionKind::Revolute => (there - here).abs(),
        MotionKind::Prismatic => (there - here).abs() / length,
    });
    moved.sum()
}

/// The posture with every passive coordinate moved by a fixed, irregular amount of size `size` rad.
pub(crate) fn nudged(chain: &Chain, posture: &[f64], size: f64) -> Vec<f64> {
    let length = chain.scale().length;
    posture
        .iter()
        .zip(chain.coordinates())
        .enumerate()
        .map(|(i, (&x, c))| {
            let golden = (i as f64 * 0.618_033_988_749_895 + 0.25).fract() - 0.5;
            match c.kind {
                MotionKind::Revolute => x + size * golden,
                MotionKind::Prismatic if c.role == Role::Passive => x + size * golden * length,
                MotionKind::Prismatic => x,
            }
        })
        .collect()
}

/// Turns (rad) and slides (natural lengths) in all beyond which one step may have passed the shape to which the
/// growing load leads.
pub(crate) const FAR: f64 = 0.2;

/// Share of the load by which it grows on the way that must not be lost.
pub(crate) const SHORT_STEP: f64 = 0.02;

/// Initial perturbation of the joints where a load begins to grow, rad: none in short steps, where the path itself
/// matters and a buckling chain stays on it.
pub(crate) fn aside(longest_step: f64) -> f64 {
    if longest_step < 1.0 { 0.0 } else { 1e-3 }
}
