//! Contribution of one limb: its masses, springs and places, by its coordinates and the motions of its base.

use kinetostat::Chain;
use kinetostat::chain::ChainTangent;
use kinetostat::model::Kinematics;
use nalgebra::{DMatrix, Matrix6xX};

use crate::error::Result;
use crate::linear::{Place, SpringPart};
use crate::mass::{MassKind, MassPart, body, segment};

/// A limb's share of the whole.
pub(crate) struct LimbShare {
    pub masses: Vec<MassPart>,
    pub springs: Vec<SpringPart>,
    pub places: Vec<Place>,
    /// `K - H` by coordinates and, where the base moves, its six motions.
    pub tangent: DMatrix<f64>,
    pub elastic: DMatrix<f64>,
    pub mass: DMatrix<f64>,
    pub tip: Matrix6xX<f64>,
}

/// Columns of the coordinates and of a base that moves, without those of the commands.
pub(crate) fn columns(chain: &Chain, kinematics: &Kinematics) -> Vec<usize> {
    let (n, r) = (chain.coordinate_count(), chain.actuators().len());
    (0..n).chain(n + r..kinematics.velocity_count()).collect()
}

/// Jacobian of a node by these columns.
pub(crate) fn jacobian(kinematics: &Kinematics, node: usize, columns: &[usize]) -> Matrix6xX<f64> {
    kinematics.jacobian(node).select_columns(columns)
}

impl LimbShare {
    /// `prefix` goes in front of names; `block` is the index of the limb's block of coordinates.
    pub fn new(chain: &Chain, prefix: &str, block: usize, at: &ChainTangent) -> Result<Self> {
        let own = columns(chain, &at.kinematics);
        let n = chain.coordinate_count();
        let mut share = Self {
            masses: Vec::new(),
            springs: Vec::new(),
            places: Vec::new(),
            tangent: DMatrix::from_fn(own.len(), own.len(), |i, j| {
                let spring = if i < n && j < n {
                    at.springs[(i, j)]
                } else {
                    0.0
                };
                spring - at.loads[(own[i], own[j])]
            }),
            elastic: DMatrix::zeros(own.len(), own.len()),
            mass: DMatrix::zeros(own.len(), own.len()),
            tip: jacobian(&at.kinematics, chain.tip(), &own),
        };
        share.add_springs(chain, prefix, block, at);
        share.add_places(chain, prefix, block, at, &own);
        share.add_bodies(chain, prefix, block, at)?;
        share.add_segments(chain, prefix, block, at);
        for part in &share.masses {
            part.add_to(&mut share.mass);
        }
        Ok(share)
    }

    fn add_springs(&mut self, chain: &Chain, prefix: &str, block: usize, at: &ChainTangent) {
        for spring in chain.springs() {
            let (first, len) = (spring.first, spring.len());
            let mut material = at.springs.view((first, first), (len, len)).into_owned();
            for (_, geometric) in at.geometric.iter().filter(|(own, _)| *own == first) {
                material -= DMatrix::from_fn(len, len, |i, j| geometric[(i, j)]);
            }
            let mut view = self.elastic.view_mut((first, first), (len, len));
            view += &material;
            self.springs.push(SpringPart {
                name: format!("{prefix}{}", spring.name),
                link: spring
                    .segment
                    .as_ref()
                    .map(|s| format!("{prefix}{}", s.link)),
                block,
                first,
                material,
            });
        }
    }

    fn add_places(
        &mut self,
        chain: &Chain,
        prefix: &str,
        block: usize,
        at: &ChainTangent,
        own: &[usize],
    ) {
        for (node, name) in chain.nodes().iter().enumerate() {
            self.places.push(Place {
                name: format!("{prefix}{name}"),
                position: at.kinematics.node_position(node),
                block,
                motions: jacobian(&at.kinematics, node, own),
            });
        }
    }

    fn add_bodies(
        &mut self,
        chain: &Chain,
        prefix: &str,
        block: usize,
        at: &ChainTangent,
    ) -> Result<()> {
        for own in chain.bodies() {
            let name = format!("{prefix}{}", own.name);
            body::check(&name, own.mass, &own.inertia)?;
            if own.mass == 0.0 && own.inertia.iter().all(|x| *x == 0.0) {
                continue;
            }
            let rotation = at.kinematics.frame(own.node).0;
            let motions = &self.places[own.node].motions;
            self.masses.push(MassPart {
                name,
                kind: MassKind::Body,
                block,
                motions: DMatrix::from_fn(6, motions.ncols(), |i, j| motions[(i, j)]),
                inertia: body::at_centre(own.mass, &own.inertia, &rotation),
            });
        }
        Ok(())
    }

    fn add_segments(&mut self, chain: &Chain, prefix: &str, block: usize, at: &ChainTangent) {
        for own in chain.segment_masses() {
            if own.total() == 0.0 {
                continue;
            }
            let eta = own.deflection(&at.kinematics);
            let (near, far) = (
                &self.places[own.near].motions,
                &self.places[own.far].motions,
            );
            let first = chain.springs()[own.spring].first;
            self.masses.push(MassPart {
                name: format!("{prefix}{}", own.link),
                kind: MassKind::Link,
                block,
                motions: segment::motions(own, &at.kinematics, near, far, first, &eta),
                inertia: segment::element(own, &eta),
            });
        }
    }
}
