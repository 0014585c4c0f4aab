//! The model that an explanation describes: map of the controller, frames of base and tool.
//!
//! A frame of the tool moves the platform that carries it, `home T`, while the chain stays: its tip is at `T^-1 end` in the new
//! frame. A frame of the base moves all that starts there, `B start`, and turns gravity. Loads and deviations that are
//! stated in a frame which changes are not stated anew; such models are refused.

use kinetostat::{MotionKind, Pose};
use kinetostat_model::schema::{
    ControllerAxisTable, ControllerCoupling, ControllerTable, ControllerUnit, Document, Placement,
};
use kinetostat_model::{Model, ModelError};
use nalgebra::{DMatrix, DVector, Vector3};

use crate::measured_poses::controller_coordinates::ControllerCoordinates;
use crate::measured_poses::explanation::{Axis, Explanation, Frame};

/// Reason why an explanation is not written as a model.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CorrectionError {
    /// Parts of the model that may be stated in a frame that changes.
    #[error("the model has {0}, stated in a frame that changes")]
    StatedInFrame(&'static str),
    /// The explanation is that of no controller.
    #[error("its axes cannot be told apart")]
    Controller,
    /// The changed model is faulty.
    #[error(transparent)]
    Model(#[from] ModelError),
}

/// A number without the rounding of the computation behind its last decimals.
fn tidy(x: f64, decimals: i32) -> f64 {
    let scale = 10_f64.powi(decimals);
    (x * scale).round() / scale + 0.0
}

/// A pose as a model file writes it, whole nanometres and millionths of a degree.
fn placement(pose: &Pose) -> Placement {
    let turn = pose.rotation.scaled_axis().map(f64::to_degrees);
    Placement {
        position_mm: Some((1e3 * pose.translation.vector).map(|x| tidy(x, 6)).into()),
        rotation_vector_deg: Some(turn.map(|x| tidy(x, 6)).into()),
        ..Placement::default()
    }
}

/// The model in which an explanation of measured poses is true; `kinds` are the motions of the controller's axes.
///
/// # Errors
/// [`CorrectionError`] for parts that are stated in a frame that changes.
pub fn corrected(
    model: &Model,
    kinds: &[MotionKind],
    explanation: &Explanation,
) -> Result<Model, CorrectionError> {
    let mut document = model.document.clone();
    let of_frame = Explanation {
        frame: explanation.frame,
        ..Explanation::default()
    };
    if *explanation != of_frame {
        let table = controller(model, kinds, explanation).ok_or(CorrectionError::Controller)?;
        document.controller = Some(table);
    }
    match &explanation.frame {
        Some(Frame::Tool(tool)) => move_tool(&mut document, model, tool)?,
        Some(Frame::Base(base)) => move_base(&mut document, base)?,
        None => {}
    }
    Ok(Model::from_document(&document, "the corrected model")?)
}

/// The map of the controller. The explanation turns what is shown, `x`, into what the declared map `M q + z` shows,
/// `A x + b`, so that the true map is `A^-1 (M q + z - b)`.
fn controller(
    model: &Model,
    kinds: &[MotionKind],
    explanation: &Explanation,
) -> Option<ControllerTable> {
    let axes = ControllerCoordinates::of(model).axes(kinds);
    let count = axes.len();
    let names = model.mechanism.actuator_names();
    let declared = model.controller.as_ref();
    let map = declared.map_or_else(|| DMatrix::identity(count, count), |c| c.map().clone());
    let joint = |i: usize| declared.map_or(i, |c| c.axes()[i].joint);
    let apply = |x: &DVector<f64>| DVector::from_vec(explanation.applied(x.as_slice(), &axes));
    let shift = apply(&DVector::zeros(count));
    let units = DMatrix::<f64>::identity(count, count);
    let units = units.column_iter().map(|unit| unit.into_owned());
    let columns: Vec<DVector<f64>> = units.map(|unit| apply(&unit) - &shift).collect();
    let back = DMatrix::from_columns(&columns).try_inverse()?;
    let zeros = DVector::from_iterator(count, axes.iter().map(|axis| axis.zero));
    let (map, zeros) = (&back * map, &back * (zeros - shift));
    let own = |i: usize| {
        let ratio = tidy(map[(i, joint(i))], 9);
        let coupled = (0..count).filter(|&k| k != i && tidy(map[(i, joint(k))], 9) != 0.0);
        let coupled =
            coupled.map(|k| coupling(&axes, [i, k], map[(i, joint(k))], &names[joint(k)]));
        let unit = match axes[i].turns {
            true => 1_f64.to_degrees(),
            false => 1e3,
        };
        let zero = Some(tidy(zeros[i] * unit, 6)).filter(|zero| *zero != 0.0);
        ControllerAxisTable {
            name: declared.map_or_else(|| names[i].clone(), |c| c.axes()[i].name.clone()),
            joint: names[joint(i)].clone(),
            reversed: (ratio < 0.0).then_some(true),
            ratio: Some(ratio.abs()).filter(|ratio| *ratio != 1.0),
            zero_offset_mm: zero.filter(|_| !axes[i].turns),
            zero_offset_m: None,
            zero_offset_deg: zero.filter(|_| axes[i].turns),
            zero_offset_rad: None,
            unit: declared
                .map(|c| c.axes()[i].unit)
                .filter(|unit| [ControllerUnit::M, ControllerUnit::Rad].contains(unit)),
            coupled: coupled.collect(),
        }
    };
    let mut table = model
        .document
        .controller
        .clone()
        .unwrap_or(ControllerTable {
            name: None,
            axis: Vec::new(),
            source: None,
            assumption: None,
        });
    table.axis = (0..count).map(own).collect();
    Some(table)
}

/// The share (m, rad) of the joint of another axis in an axis.
fn coupling(axes: &[Axis], pair: [usize; 2], share: f64, joint: &str) -> ControllerCoupling {
    let [own, other] = pair.map(|i| axes[i].turns);
    let mm_per_deg = 1e3 / 1_f64.to_degrees();
    let same = (own == other).then(|| tidy(share, 9));
    ControllerCoupling {
        joint: joint.to_owned(),
        ratio: same,
        ratio_mm_per_deg: (!own && other).then(|| tidy(share * mm_per_deg, 9)),
        ratio_deg_per_mm: (own && !other).then(|| tidy(share / mm_per_deg, 9)),
    }
}

/// Puts the frame of the tool elsewhere: `tool` is the new one in the old.
fn move_tool(document: &mut Document, model: &Model, tool: &Pose) -> Result<(), CorrectionError> {
    let mechanism = &model.mechanism;
    let carrier = &mechanism.platforms()[mechanism.tool()];
    refuse_stated(document, &[(carrier.mass != 0.0, "a mass of its platform")])?;
    move_ends(document, &carrier.name, &tool.inverse());
    let platforms = document.platform.iter_mut();
    for platform in platforms.filter(|p| p.name == carrier.name) {
        platform.home = placement(&(carrier.home * tool));
    }
    Ok(())
}

/// Puts the base frame elsewhere: `base` is the old one in the new.
fn move_base(document: &mut Document, base: &Pose) -> Result<(), CorrectionError> {
    let loaded = document.limb.iter().any(|limb| !limb.load.is_empty());
    let workspace = document.workspace.is_some();
    refuse_stated(document, &[(loaded, "loads"), (workspace, "a workspace")])?;
    move_ends(document, "base", base);
    for platform in &mut document.platform {
        platform.home = placement(&(base * pose(Some(&platform.home))));
    }
    if let Some(gravity) = &mut document.mechanism.gravity_m_per_s2 {
        let turned = base.rotation * Vector3::from(*gravity);
        *gravity = turned.map(|x| tidy(x, 6)).into();
    }
    Ok(())
}

/// States the ends of limbs at a platform or at the base in a new frame; `new` is the old frame in it.
fn move_ends(document: &mut Document, at: &str, new: &Pose) {
    let moved = |end: &Option<Placement>| Some(placement(&(new * pose(end.as_ref()))));
    for limb in &mut document.limb {
        if limb.from == at {
            limb.start = moved(&limb.start);
        }
        if limb.to == at {
            limb.end = moved(&limb.end);
        }
    }
}

/// Refuses models with parts that may be stated in a frame that changes.
fn refuse_stated(document: &Document, own: &[(bool, &'static str)]) -> Result<(), CorrectionError> {
    let all = [
        (!document.load.is_empty(), "loads"),
        (!document.deviation.is_empty(), "deviations"),
        (!document.rotary_axis.is_empty(), "rotary axes"),
    ];
    match all.iter().chain(own).find(|(is_stated, _)| *is_stated) {
        Some((_, what)) => Err(CorrectionError::StatedInFrame(what)),
        None => Ok(()),
    }
}

/// The pose of a placement in a model that was read.
fn pose(placement: Option<&Placement>) -> Pose {
    let read = placement.and_then(|placement| placement.pose().ok());
    read.unwrap_or_else(Pose::identity)
}
