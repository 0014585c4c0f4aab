//! A machine linearised about a loaded equilibrium: `M x'' + C x' + (K - H) x = B^T w` [D3, D5].

pub(crate) mod build;
pub(crate) mod limb;
pub(crate) mod machine;
pub(crate) mod places;
pub(crate) mod rotor;

use nalgebra::{DMatrix, DVector, Matrix6xX};

use crate::mass::MassPart;

/// A spring: its motions by the coordinates of its block, and its stiffness.
#[derive(Clone, Debug)]
pub(crate) struct SpringPart {
    pub name: String,
    /// Link of which it is a piece.
    pub link: Option<String>,
    pub block: usize,
    /// First coordinate in the block.
    pub first: usize,
    /// Material stiffness at the equilibrium, k x k.
    pub material: DMatrix<f64>,
}

/// A place of the machine: a node of a limb, or a platform.
#[derive(Clone, Debug)]
pub(crate) struct Place {
    pub name: String,
    pub position: nalgebra::Vector3<f64>,
    /// Block that moves it, and its motions by the coordinates of that block, 6 x n.
    pub block: usize,
    pub motions: Matrix6xX<f64>,
}

/// A joint or spring coordinate by name: where viscous damping acts.
#[derive(Clone, Debug)]
pub(crate) struct NamedCoordinate {
    pub name: String,
    /// Index among all coordinates.
    pub index: usize,
}

/// The mass of an elastic link that is put to its far end: a body right behind it whose centre lies along it. Where the link
/// bends by itself, all of that mass goes with the end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LumpedLink {
    /// Name of the link.
    pub link: String,
    /// Name of the body.
    pub body: String,
}

/// A machine about a loaded equilibrium: mass, tangent stiffness and the motions of its nodes by independent
/// coordinates, all at the LOADED posture. `M`, `K - H` and the rest by [`Self::mass`] and its neighbours; modes by
/// [`Self::modes`]; responses by [`crate::ModalResponse`] and [`Self::direct`].
///
/// The coordinates are those of the limbs (passive and elastic alike, m or rad) where nothing closes a loop and nothing
/// is held, and independent combinations of them and of the platforms' motions otherwise.
///
/// ```
/// # use kinetostat::nalgebra::{Matrix3, Vector3, vector};
/// # use kinetostat::*;
/// use kinetostat_dynamics::{Held, LinearDynamics};
///
/// // A pendulum: 3 kg at 0.7 m, on a spring of 40 N m/rad.
/// let pendulum = Chain::builder("pendulum")
///     .spring("pivot", MotionKind::Revolute, Vector3::y(), 40.0, 0.0)
///     .body("bob", 3.0, vector![0.0, 0.0, -0.7], Matrix3::zeros())
///     .build()?;
/// let mut problem = ChainProblem::new(&pendulum, EndCondition::wrench(Wrench::zero()));
/// problem.loads.push(Load::gravity(vector![0.0, 0.0, -9.81]));
/// let at_rest = solve_chain(&problem, &Settings::default())?;
/// let dynamics = LinearDynamics::of_chain(&problem, &at_rest.coordinates, &at_rest.wrench, &Held::nothing())?;
/// let squared = dynamics.modes()?.modes[0].squared; // (rad/s)^2
/// assert!((squared - (40.0 / (3.0 * 0.49) + 9.81 / 0.7)).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct LinearDynamics {
    pub(crate) name: String,
    /// Mass matrix, m x m, by independent coordinates.
    pub(crate) mass: DMatrix<f64>,
    /// `K - H`, m x m.
    pub(crate) tangent: DMatrix<f64>,
    /// Material stiffness of the springs, m x m.
    pub(crate) elastic: DMatrix<f64>,
    /// All coordinates by the independent ones; `None` where they are the same.
    pub(crate) basis: Option<DMatrix<f64>>,
    /// Natural units of the independent coordinates: metres and radians become comparable.
    pub(crate) units: Vec<f64>,
    /// Indices of the coordinates of each block.
    pub(crate) blocks: Vec<Vec<usize>>,
    pub(crate) masses: Vec<MassPart>,
    pub(crate) springs: Vec<SpringPart>,
    pub(crate) places: Vec<Place>,
    pub(crate) coordinates: Vec<NamedCoordinate>,
    /// Index of the tool among the places.
    pub(crate) tool: usize,
    /// Natural length, m.
    pub(crate) length: f64,
    /// Links of one segment: too few to judge a circulatory load.
    pub(crate) coarse_links: Vec<String>,
    pub(crate) lumped_links: Vec<LumpedLink>,
}

impl LinearDynamics {
    /// Number of independent coordinates.
    #[must_use]
    pub fn len(&self) -> usize {
        self.mass.nrows()
    }

    /// True if nothing can move.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.mass.nrows() == 0
    }

    /// Name of the chain or machine.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Names of links in one segment: what bends within them is too stiff by a fifth, in frequency a tenth.
    #[must_use]
    pub fn coarse_links(&self) -> &[String] {
        &self.coarse_links
    }

    /// Links whose masses stand as bodies at their far ends. A mode in which such a link bends under its own body is too low,
    /// by up to two thirds for a bar that is held at both ends: its mass belongs along it
    /// ([`kinetostat::LinkSpec::with_mass`]).
    #[must_use]
    pub fn lumped_links(&self) -> &[LumpedLink] {
        &self.lumped_links
    }

    /// Mass matrix `M` by independent coordinates: kg, kg m, kg m^2 by the units of the coordinates.
    #[must_use]
    pub fn mass(&self) -> &DMatrix<f64> {
        &self.mass
    }

    /// Tangent stiffness `K - H`: springs with the bowing of links, less the loads' tangent. Symmetric where all loads have
    /// a potential.
    #[must_use]
    pub fn tangent(&self) -> &DMatrix<f64> {
        &self.tangent
    }

    /// Material stiffness of the springs alone, without loads and without what links gain by bowing: what structural
    /// damping multiplies.
    #[must_use]
    pub fn elastic(&self) -> &DMatrix<f64> {
        &self.elastic
    }

    /// Parts with mass.
    #[must_use]
    pub fn mass_parts(&self) -> &[MassPart] {
        &self.masses
    }

    /// Total mass of bodies, platforms and links, kg, each counted once.
    #[must_use]
    pub fn total_mass(&self) -> f64 {
        self.masses
            .iter()
            .map(|part| match part.kind {
                crate::mass::MassKind::Rotor => 0.0,
                _ => part.inertia[(0, 0)],
            })
            .sum()
    }

    /// Returns a motion in terms of all coordinates.
    pub(crate) fn all(&self, independent: &DVector<f64>) -> DVector<f64> {
        match &self.basis {
            Some(basis) => basis * independent,
            None => independent.clone(),
        }
    }

    /// The coordinates of a block, out of all.
    pub(crate) fn of_block(&self, block: usize, all: &DVector<f64>) -> DVector<f64> {
        let own = &self.blocks[block];
        DVector::from_iterator(own.len(), own.iter().map(|&i| all[i]))
    }

    /// Largest difference of `K - H` and its transpose, as a share of the geometric mean of the diagonals.
    #[must_use]
    pub fn asymmetry(&self) -> f64 {
        let k = &self.tangent;
        let diagonal: Vec<f64> = (0..k.nrows())
            .map(|i| {
                // A free coordinate has no stiffness of its own: then by the springs of its row.
                let row = k
                    .row(i)
                    .iter()
                    .fold(0.0_f64, |m, x| kinetostat::number::larger(m, x.abs()));
                kinetostat::number::larger(k[(i, i)].abs(), row)
            })
            .collect();
        let mut worst = 0.0_f64;
        for i in 0..k.nrows() {
            for j in 0..i {
                let size = (diagonal[i] * diagonal[j]).sqrt();
                let off = (k[(i, j)] - k[(j, i)]).abs();
                if off > 0.0 {
                    worst = kinetostat::number::larger(worst, off / size);
                }
            }
        }
        worst
    }

    /// Loads without a potential: `K - H` is not symmetric, and stability is a question of complex modes
    /// ([`Self::complex_modes`]).
    #[must_use]
    pub fn is_circulatory(&self) -> bool {
        self.asymmetry() > CIRCULATORY
    }
}

/// Smallest asymmetry of a circulatory system, see [`LinearDynamics::asymmetry`]; rounding stays a thousand times
/// below.
pub(crate) const CIRCULATORY: f64 = 1e-10;
