//! Masses along links, as steps of a plan [D 5].
//!
//! A segment of mass `m` and length `h` with `eta = (u, v, w, rx, ry, rz)` from its near to its far end
//! ([`crate::model::link_mass`]) has its first moment about the near end, near axes, at
//!
//! ```text
//! m (h/2 + u/2,  v/2 - h rz/12,  w/2 + h ry/12):   the shapes of bending integrated, with every shear ratio
//! ```
//!
//! With `(h + u, v, w)` from the near to the far end, its weight has the potential
//! `V = -g . (m/2 p_near + m/2 p_far + R_near (0, -k rz, k ry))`, `k = m h / 12`: half of the mass at either end, which
//! are points as any, and what the weight bends the segment by, see [`crate::batch::limb::own_weight`]. Links have their
//! nodes, offsets along x and springs in one set of axes ([`crate::ChainBuilder::link_with`]), and `ry` and `rz` are coordinates
//! of the spring wherever it lies between the ends.

use crate::batch::plan::steps::OwnWeight;
use crate::model::chain::Chain;
use crate::model::springs::block::SpringBlock;

/// Half of the mass of the segments that begin or end at a node, kg; `None` where none does.
pub(super) fn halves_at(chain: &Chain, node: usize) -> Option<f64> {
    let segments = chain.segment_masses().iter();
    let own = segments.filter(|s| s.near == node || s.far == node);
    own.map(|s| 0.5 * s.total()).reduce(|a, b| a + b)
}

/// A segment with a mass along it begins at a node.
pub(super) fn begins_at(chain: &Chain, node: usize) -> bool {
    chain.segment_masses().iter().any(|s| s.near == node)
}

/// Effect of the segment's weight on a spring with these coordinates in the six directions, behind so many masses;
/// `None` for a spring without a mass along it.
pub(super) fn own_weight(
    chain: &Chain,
    block: &SpringBlock,
    coordinates: &[Option<usize>; 6],
    masses: usize,
) -> Result<Option<OwnWeight>, &'static str> {
    let mut segments = chain.segment_masses().iter();
    let Some(segment) = segments.find(|s| chain.springs()[s.spring].first == block.first) else {
        return Ok(None);
    };
    // The last one is at the node before the spring.
    let Some(near) = masses.checked_sub(1) else {
        return Err("has a mass along it and no node before it");
    };
    let [_, _, _, _, Some(ry), Some(rz)] = *coordinates else {
        return Err("has a mass along it and does not bend both ways");
    };
    Ok(Some(OwnWeight {
        near,
        turns: [ry, rz],
        moment: segment.total() * segment.length / 12.0,
    }))
}
