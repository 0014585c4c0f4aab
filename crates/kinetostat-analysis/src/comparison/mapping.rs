//! The mapping of one machine on another: signs and offsets of the joints, base and tool.

use kinetostat::Pose;

/// Mapping of machine `b` to machine `a`: `T_a(q) = base * T_b(s q + o) * tool` for all `q`.
#[derive(Clone, Debug, PartialEq)]
pub struct Mapping {
    /// -1 or 1 for each joint.
    pub signs: Vec<f64>,
    /// m or rad, added to `b`'s joint.
    pub offsets: Vec<f64>,
    /// Base of `a` from base of `b`.
    pub base: Pose,
    /// Tool of `b` from tool of `a`.
    pub tool: Pose,
    /// Largest difference left over all postures, m and rad.
    pub largest_difference: (f64, f64),
}

impl Mapping {
    /// The joints of `b` where those of `a` are, m or rad.
    #[must_use]
    pub fn joints(&self, a: &[f64]) -> Vec<f64> {
        let both = self.signs.iter().zip(&self.offsets);
        both.zip(a).map(|((s, o), q)| s * q + o).collect()
    }

    /// Fewer reversed joints, moved zeros and frames are plainer.
    pub(crate) fn changes(&self) -> usize {
        let frame = |p: &Pose| {
            usize::from(p.translation.vector.norm() > 1e-7 || p.rotation.angle() > 1e-7) * 3
        };
        2 * self.signs.iter().filter(|s| **s < 0.0).count()
            + self.offsets.iter().filter(|o| o.abs() > 1e-7).count()
            + frame(&self.base)
            + frame(&self.tool)
    }
}
