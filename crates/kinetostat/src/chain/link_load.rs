//! Closeness of every link to buckling: its axial force as a share of its Euler load.

use nalgebra::Vector3;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::chain::equilibrium::Equilibrium;
use crate::model::chain::Chain;

/// Axial load of a link.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[non_exhaustive]
pub struct LinkLoad {
    /// Name of the link.
    pub link: String,
    /// Axial force of its most compressed segment, N; negative compresses.
    pub axial_force: f64,
    /// Euler load `pi^2 EI / L^2` of the whole link with both ends pinned, in its softer plane, N.
    pub euler_load: f64,
    /// Compression as a share of the Euler load; zero in tension. Near 1 and above, the link buckles
    /// or comes near it (a link with a free end does so at 1/4, one with clamped ends at 4).
    pub share: f64,
}

/// Axial load of every link, from the torques of all springs of its chain
/// ([`Equilibrium::spring_torques`]).
#[must_use]
pub fn link_loads(chain: &Chain, spring_torques: &[f64]) -> Vec<LinkLoad> {
    let mut list: Vec<LinkLoad> = Vec::new();
    for block in chain.springs() {
        let (Some(segment), Some(&[x, y, z])) = (
            &block.segment,
            spring_torques
                .get(block.first..)
                .and_then(<[f64]>::first_chunk),
        ) else {
            continue;
        };
        let axial = segment.along.dot(&Vector3::new(x, y, z));
        let link = match list.iter().position(|l| l.link == segment.link) {
            Some(k) => &mut list[k],
            None => {
                let slenderness = std::f64::consts::PI / segment.link_length;
                list.push(LinkLoad {
                    link: segment.link.clone(),
                    axial_force: axial,
                    euler_load: slenderness * slenderness * segment.bending_stiffness,
                    share: 0.0,
                });
                let last = list.len() - 1;
                &mut list[last]
            }
        };
        link.axial_force = link.axial_force.min(axial);
        link.share = (-link.axial_force / link.euler_load).max(0.0);
    }
    list
}

impl Equilibrium {
    /// Axial load of every link of the chain that is in this equilibrium.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let (length, bar) = (0.5, BeamSection::tube(2.1e11, 8.1e10, 0.04, 0.0)); // m, Pa
    /// # let ei = 2.1e11 * bar.second_moment_z; // N m^2
    /// let column = Chain::builder("column").link("bar", &bar, length).build()?;
    /// for force in [-4e4, 4e4] {
    ///     let load = Wrench::new(vector![force, 0.0, 0.0], Vector3::zeros()); // N
    ///     let found = solve_chain(&ChainProblem::new(&column, EndCondition::wrench(load)), &Settings::default())?;
    ///     let bar = &found.link_loads(&column)[0];
    ///     assert!((bar.axial_force - force).abs() < 1e-6);
    ///     // Tension buckles nothing; compression counts against pi^2 E I / L^2.
    ///     let euler = (std::f64::consts::PI / length).powi(2) * ei;
    ///     assert!((bar.share - (-force / euler).max(0.0)).abs() < 1e-9);
    /// }
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn link_loads(&self, chain: &Chain) -> Vec<LinkLoad> {
        link_loads(chain, &self.spring_torques)
    }
}
