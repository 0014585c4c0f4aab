//! A chain stage by stage: motions, springs, what loads and masses add at nodes and along segments.
//!
//! With `t_c` the motion (a twist at the tip's place) of what lies beyond stage `c`, `t_c = t_(c-1) + s_c x_c`, the energy
//! of a small motion is a sum over stages and nodes. Loads change as in the sweeps of the statics
//! (`kinetostat::chain`), in exponential coordinates, so that all is symmetric.

use kinetostat::chain::ChainPieces;
use kinetostat::model::{Element, Kinematics, SegmentMass, turn_rates};
use kinetostat::spatial::{hat, shift_matrix};
use kinetostat::{Chain, Wrench};
use nalgebra::{DMatrix, Matrix3, Matrix6, Matrix6xX, Vector3, Vector6};

use crate::error::Result;
use crate::mass::{body, segment};

/// Coordinates that are eliminated together: a spring, or a passive joint.
#[derive(Clone, Debug)]
pub(crate) struct Stage {
    pub first: usize,
    /// Twists at the tip's place by its coordinates, 6 x k.
    pub twists: Matrix6xX<f64>,
    /// Stiffness of the spring, k x k.
    pub spring: DMatrix<f64>,
    /// `A / 2` of the loads beyond it.
    pub outer: Matrix6<f64>,
    /// Terms of loads and masses that depend on both its near side and its own coordinates.
    pub loads: Both,
    pub masses: Both,
}

/// Forms of loads (with the sign of `H`) and masses in one motion.
#[derive(Clone, Debug)]
pub(crate) struct Forms {
    pub loads: Matrix6<f64>,
    pub masses: Matrix6<f64>,
}

impl Forms {
    fn zeros() -> Self {
        Self {
            loads: Matrix6::zeros(),
            masses: Matrix6::zeros(),
        }
    }
}

/// A chain at one state.
#[derive(Clone, Debug)]
pub(crate) struct Stages {
    pub stages: Vec<Stage>,
    /// Forms at nodes before the first stage, beyond the first, beyond the second, ...
    pub between: Vec<Forms>,
    pub count: usize,
}

/// First coordinate and number of coordinates of each stage, and how many stages stand before each node.
type Sequence = (Vec<(usize, usize)>, Vec<usize>);

/// The stages of a chain in their order; `None` of a chain that is no
/// sequence of stages: a coordinate drives several motions.
fn sequence(chain: &Chain) -> Option<Sequence> {
    let mut of_spring = vec![1; chain.coordinate_count()];
    for block in chain.springs() {
        *of_spring.get_mut(block.first)? = block.len();
    }
    let (mut stages, mut before) = (Vec::new(), Vec::new());
    let (mut next, mut missing) = (0, 0);
    for element in chain.elements() {
        match element {
            Element::Rigid(_) => {}
            Element::Node(index) => {
                if missing > 0 || *index != before.len() {
                    return None;
                }
                before.push(stages.len());
            }
            Element::Motion(motion) => {
                let Some(drive) = motion.coordinate else {
                    continue;
                };
                if drive.index != next {
                    return None;
                }
                next += 1;
                if missing > 0 {
                    missing -= 1;
                    continue;
                }
                missing = of_spring[drive.index] - 1;
                stages.push((drive.index, missing + 1));
            }
        }
    }
    let whole = next == chain.coordinate_count() && missing == 0 && !stages.is_empty();
    let blocks = chain.springs().iter();
    let starts = blocks
        .map(|b| b.first)
        .all(|first| stages.binary_search_by_key(&first, |s| s.0).is_ok());
    (whole && starts).then_some((stages, before))
}

impl Stages {
    /// `None` of a chain that is no sequence of stages. Masses of bodies are checked.
    pub fn new(chain: &Chain, at: &ChainPieces) -> Result<Option<Self>> {
        let Some((sequence, before)) = sequence(chain) else {
            return Ok(None);
        };
        let kinematics = &at.kinematics;
        let jacobian = kinematics.jacobian(chain.tip());
        let mut stages: Vec<Stage> = sequence
            .iter()
            .map(|&(first, count)| Stage {
                first,
                twists: jacobian.columns(first, count).into_owned(),
                spring: DMatrix::zeros(count, count),
                outer: Matrix6::zeros(),
                loads: Both::zeros(count),
                masses: Both::zeros(count),
            })
            .collect();
        let stage_of = |first: usize| sequence.binary_search_by_key(&first, |s| s.0).ok();
        for (block, spring) in chain.springs().iter().zip(&at.springs) {
            if let Some(stage) = stage_of(block.first) {
                stages[stage].spring += spring;
            }
        }
        let mut own = Self {
            between: vec![Forms::zeros(); stages.len() + 1],
            stages,
            count: chain.coordinate_count(),
        };
        if !own.add_loads(chain, at, &before) {
            return Ok(None);
        }
        let tip = kinematics.node_position(chain.tip());
        for part in chain.bodies() {
            body::check(&part.name, part.mass, &part.inertia)?;
            let (rotation, place) = kinematics.frame(part.node);
            let form = body::about_point(part.mass, &part.inertia, &rotation, &(place - tip));
            own.between[before[part.node]].masses += form;
        }
        for segment in chain.segment_masses() {
            let first = chain.springs()[segment.spring].first;
            let (Some(stage), near) = (stage_of(first), before[segment.near]) else {
                return Ok(None);
            };
            if near != stage || before[segment.far] != stage + 1 {
                return Ok(None);
            }
            let twists = own.stages[stage].twists.clone();
            add_segment(
                segment,
                kinematics,
                &tip,
                &twists,
                &mut own.stages[stage].masses,
            );
        }
        Ok(Some(own))
    }

    /// False where a load ties motions of nodes together that are more than a stage apart.
    fn add_loads(&mut self, chain: &Chain, at: &ChainPieces, before: &[usize]) -> bool {
        let kinematics = &at.kinematics;
        let tip = kinematics.node_position(chain.tip());
        let mut outer = vec![Vector6::zeros(); self.stages.len() + 1];
        for (node, wrench) in &at.wrenches {
            let (f, arm) = (wrench.force(), kinematics.node_position(*node) - tip);
            outer[before[*node]] += Wrench::new(f, wrench.moment() + arm.cross(&f)).0;
            let mut form = Matrix6::zeros();
            form.fixed_view_mut::<3, 3>(3, 0).copy_from(&-hat(&f));
            form.fixed_view_mut::<3, 3>(3, 3)
                .copy_from(&(hat(&f) * hat(&arm)));
            self.between[before[*node]].loads += symmetric(&form);
        }
        for tangent in &at.tangents {
            let (on, by) = (before[tangent.on], before[tangent.by]);
            if on.abs_diff(by) > 1 {
                return false;
            }
            let shift = |node| shift_of(kinematics, node, &tip);
            let form = shift(tangent.on).transpose() * tangent.matrix * shift(tangent.by);
            if on == by {
                self.between[on].loads += symmetric(&form);
                continue;
            }
            // The form couples two nodes, and the nearer moves with the near side alone: t^T G (t + s x), symmetric.
            let stage = &mut self.stages[on.min(by)];
            stage.loads.near += symmetric(&form);
            let turned = if on < by { form } else { form.transpose() };
            stage.loads.across += turned * &stage.twists * 0.5;
        }
        let mut sum = Vector6::zeros();
        for (c, stage) in self.stages.iter_mut().enumerate().rev() {
            sum += outer[c + 1];
            let (f, m) = (hat(&Wrench(sum).force()), hat(&Wrench(sum).moment()));
            stage
                .outer
                .fixed_view_mut::<3, 3>(0, 3)
                .copy_from(&(f * 0.5));
            stage
                .outer
                .fixed_view_mut::<3, 3>(3, 0)
                .copy_from(&(f * 0.5));
            stage
                .outer
                .fixed_view_mut::<3, 3>(3, 3)
                .copy_from(&(m * 0.5));
        }
        true
    }
}

pub(crate) fn symmetric(a: &Matrix6<f64>) -> Matrix6<f64> {
    (a + a.transpose()) * 0.5
}

/// A symmetric form in the motion of the near side (6) and the own coordinates (k) of a stage.
#[derive(Clone, Debug)]
pub(crate) struct Both {
    pub near: Matrix6<f64>,
    pub across: Matrix6xX<f64>,
    pub own: DMatrix<f64>,
}

impl Both {
    pub fn zeros(count: usize) -> Self {
        Self {
            near: Matrix6::zeros(),
            across: Matrix6xX::zeros(count),
            own: DMatrix::zeros(count, count),
        }
    }
}

/// Adds the mass of a segment; `twists` are those of the spring's coordinates at the tip's place.
fn add_segment(
    own: &SegmentMass,
    kinematics: &Kinematics,
    tip: &Vector3<f64>,
    twists: &Matrix6xX<f64>,
    to: &mut Both,
) {
    if own.total() == 0.0 {
        return;
    }
    let eta = own.deflection(kinematics);
    let inertia = segment::element(own, &eta);
    let axes = kinematics.frame(own.near).0.transpose();
    let both = |angular: &Matrix3<f64>| {
        let mut turn = Matrix6::zeros();
        turn.fixed_view_mut::<3, 3>(0, 0).copy_from(&axes);
        turn.fixed_view_mut::<3, 3>(3, 3).copy_from(angular);
        turn
    };
    let near = both(&axes) * shift_of(kinematics, own.near, tip);
    let rates = turn_rates(eta[3], eta[4])
        .try_inverse()
        .unwrap_or_else(|| Matrix3::from_element(f64::NAN));
    let far = both(&(rates * axes)) * shift_of(kinematics, own.far, tip) * twists;
    let block = |i: usize, j: usize| Matrix6::from_fn(|r, c| inertia[(i + r, j + c)]);
    to.near += near.transpose() * block(0, 0) * near;
    to.across += near.transpose() * block(0, 6) * &far;
    let moved = block(6, 6) * &far;
    to.own += DMatrix::from_fn(far.ncols(), far.ncols(), |i, j| {
        far.column(i).dot(&moved.column(j))
    });
}

/// Motion of a node by that of its part at the tip's place.
fn shift_of(kinematics: &Kinematics, node: usize, tip: &nalgebra::Vector3<f64>) -> Matrix6<f64> {
    shift_matrix(&(kinematics.node_position(node) - tip))
}
