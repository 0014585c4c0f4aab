//! Poses and directions as a file writes them, and corners of the workspace.

use kinetostat::Pose;
use nalgebra::{Matrix3, Quaternion, Rotation3, Unit, UnitQuaternion, Vector3};

use crate::elements::quantity::{DEG, Given, MM, ReadResult, choices, need, pick, vector};
use crate::problem::{Finding, KeyPath};
use crate::schema::{Axis, AxisName, Document, Placement};

/// Angles of an orientation are within a hundred full turns, rad. Degrees that are taken for rad are: an imported
/// model says what looks like them.
const MOST_TURNED: f64 = 100.0 * std::f64::consts::TAU;

/// Refuses a vector without a component above 1e-12.
pub(crate) fn direction(place: &KeyPath, axis: &Axis) -> ReadResult<Unit<Vector3<f64>>> {
    let v = match axis {
        Axis::Named(AxisName::X) => Vector3::x(),
        Axis::Named(AxisName::Y) => Vector3::y(),
        Axis::Named(AxisName::Z) => Vector3::z(),
        Axis::Named(AxisName::MinusX) => -Vector3::x(),
        Axis::Named(AxisName::MinusY) => -Vector3::y(),
        Axis::Named(AxisName::MinusZ) => -Vector3::z(),
        Axis::Vector(v) => Vector3::from(*v),
    };
    // Scaling by the largest component first keeps squares of tiny and huge numbers finite.
    let largest = v.amax();
    Unit::try_new(v / largest, 1e-12)
        .filter(|u| largest > 1e-12 && u.iter().all(|x| x.is_finite()))
        .ok_or_else(|| {
            Finding::new(
                place,
                format!("the axis [{}, {}, {}] has no direction", v.x, v.y, v.z),
                "write a letter (\"x\", \"-x\", ...) or three numbers that are not all zero",
            )
        })
}

/// Axes of a link that lies along `x`: y horizontal (z cross x), or y cross x where x is nearly
/// vertical.
pub(crate) fn frame_along(x: &Unit<Vector3<f64>>) -> Rotation3<f64> {
    let helper = if x.z.abs() < 0.9 {
        Vector3::z()
    } else {
        Vector3::y()
    };
    let y = helper.cross(x).normalize();
    Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x.into_inner(), y, x.cross(&y)]))
}

impl Placement {
    /// The pose that it means, exactly; what is not given is zero.
    ///
    /// # Errors
    /// What is wrong, and what to do: two orientations, a number that is too large, axes without direction.
    pub fn pose(&self) -> Result<Pose, (String, String)> {
        pose(&KeyPath::root(), self).map_err(|found| (found.message, found.help))
    }
}

/// The pose; what is not given is zero.
pub(crate) fn pose(place: &KeyPath, p: &Placement) -> ReadResult<Pose> {
    let translation = vector(
        place,
        "position",
        &choices!(
            p,
            (translation_mm, MM),
            (translation_m, 1.0),
            (position_mm, MM),
            (position_m, 1.0)
        ),
    )?;
    let pose = Pose::from_parts(translation.into(), orientation(place, p)?);
    // Squares of huge rotation vectors overflow.
    match pose.to_homogeneous().iter().all(|x| x.is_finite()) {
        true => Ok(pose),
        false => Err(Finding::new(
            place,
            "the pose holds a number that is too large",
            "check the figures and their units",
        )),
    }
}

/// The orientation that a placement means: at most one of the conventions is written.
fn orientation(place: &KeyPath, p: &Placement) -> ReadResult<UnitQuaternion<f64>> {
    let angles = pick(
        place,
        "orientation",
        &choices!(
            p,
            (rotation_vector_deg, DEG),
            (rotation_vector_rad, 1.0),
            (rotation_intrinsic_xyz_deg, DEG),
            (roll_pitch_yaw_urdf_deg, DEG),
            (roll_pitch_yaw_urdf_rad, 1.0),
            (a_b_c_kuka_deg, DEG),
            (w_p_r_fanuc_deg, DEG)
        ),
    )?;
    let quaternion = pick(
        place,
        "orientation",
        &choices!(p, (quaternion_wxyz, 1.0), (quaternion_xyzw, 1.0)),
    )?;
    let axes = p
        .x_axis
        .as_ref()
        .map(|_| "x_axis")
        .or(p.y_axis.as_ref().map(|_| "y_axis"));
    let mut forms = [angles.map(|g| g.key), quaternion.map(|g| g.key), axes]
        .into_iter()
        .flatten();
    if let (Some(one), Some(other)) = (forms.next(), forms.next()) {
        return Err(Finding::new(
            &place.key(other),
            format!("the orientation is given twice: '{one}' and '{other}'"),
            "keep one of them",
        ));
    }
    match (angles, quaternion) {
        (Some(given), _) => from_angles(place, &given),
        (None, Some(given)) => from_quaternion(place, &given),
        (None, None) => from_axes(place, p),
    }
}

/// Three numbers, whose key names the convention.
fn from_angles(place: &KeyPath, given: &Given<[f64; 3]>) -> ReadResult<UnitQuaternion<f64>> {
    let [a, b, c] = given.value;
    if given.value.iter().any(|angle| angle.abs() > MOST_TURNED) {
        return Err(Finding::new(
            &place.key(given.key),
            "an angle is more than a hundred full turns",
            "check the number and its unit, deg or rad",
        ));
    }
    let (x, y, z) = (Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis());
    let turn = UnitQuaternion::from_axis_angle;
    Ok(match given.key {
        "rotation_vector_deg" | "rotation_vector_rad" => {
            UnitQuaternion::from_scaled_axis(Vector3::new(a, b, c))
        }
        "rotation_intrinsic_xyz_deg" => turn(&x, a) * turn(&y, b) * turn(&z, c),
        "a_b_c_kuka_deg" => turn(&z, a) * turn(&y, b) * turn(&x, c),
        _ => turn(&z, c) * turn(&y, b) * turn(&x, a),
    })
}

/// Four numbers, whose key names their order.
fn from_quaternion(place: &KeyPath, given: &Given<[f64; 4]>) -> ReadResult<UnitQuaternion<f64>> {
    let [a, b, c, d] = given.value;
    let q = match given.key {
        "quaternion_wxyz" => Quaternion::new(a, b, c, d),
        _ => Quaternion::new(d, a, b, c),
    };
    let length = q.norm();
    if (length - 1.0).abs() > 1e-3 {
        return Err(Finding::new(
            &place.key(given.key),
            format!("the quaternion has the length {length}, 1 is needed"),
            "write the four numbers with at least four digits, in the order that the key names",
        ));
    }
    Ok(UnitQuaternion::from_quaternion(q))
}

/// Directions of the new axes; the turn about x is that of a link where y is not given.
fn from_axes(place: &KeyPath, p: &Placement) -> ReadResult<UnitQuaternion<f64>> {
    match (&p.x_axis, &p.y_axis) {
        (None, None) => Ok(UnitQuaternion::identity()),
        (None, Some(_)) => Err(Finding::new(
            &place.key("y_axis"),
            "'y_axis' is given without 'x_axis'",
            "write x_axis too",
        )),
        (Some(x), None) => {
            let x = direction(&place.key("x_axis"), x)?;
            Ok(UnitQuaternion::from_rotation_matrix(&frame_along(&x)))
        }
        (Some(x), Some(y)) => {
            let x = direction(&place.key("x_axis"), x)?;
            let y = direction(&place.key("y_axis"), y)?;
            let slant = x.dot(&y);
            if slant.abs() > 1e-6 {
                return Err(Finding::new(
                    &place.key("y_axis"),
                    format!(
                        "'y_axis' is not square to 'x_axis': {:.4} degrees instead of 90",
                        slant.clamp(-1.0, 1.0).acos() / DEG
                    ),
                    "correct one of them, or leave out y_axis where the turn about x does not matter",
                ));
            }
            let z = x.cross(&y).normalize();
            let columns = Matrix3::from_columns(&[x.into_inner(), z.cross(&x), z]);
            Ok(UnitQuaternion::from_rotation_matrix(
                &Rotation3::from_matrix_unchecked(columns),
            ))
        }
    }
}

/// A pose as this crate writes it.
pub(crate) fn written(pose: &Pose) -> Placement {
    Placement {
        translation_m: Some(pose.translation.vector.into()),
        rotation_vector_rad: Some(pose.rotation.scaled_axis().into()),
        ..Placement::default()
    }
}

/// Three significant digits, nothing below a billionth.
pub(crate) fn three_digits(value: f64) -> String {
    match value < 1e-9 {
        true => "0".to_owned(),
        false => format!("{value:.2e}").parse().unwrap_or(value).to_string(),
    }
}

/// A pose as the line of a file: `home = { .. }`, with the digits that a machine can tell apart.
pub(crate) fn written_pose(pose: &Pose) -> String {
    let list = |v: [f64; 3], decimals: i32| {
        let unit = 10_f64.powi(decimals);
        let parts = v.map(|x| format!("{}", (x * unit).round() / unit + 0.0));
        parts.join(", ")
    };
    let position = list((pose.translation.vector * 1e3).into(), 9);
    let turn = pose.rotation.scaled_axis();
    if turn.norm() < 1e-11 {
        return format!("home = {{ position_mm = [{position}] }}");
    }
    let turn = list(turn.map(f64::to_degrees).into(), 10);
    format!("home = {{ position_mm = [{position}], rotation_vector_deg = [{turn}] }}")
}

/// The workspace's corners.
pub(crate) fn corners(document: &Document) -> ReadResult<Option<Corners>> {
    let Some(w) = &document.workspace else {
        return Ok(None);
    };
    let place = KeyPath::root().key("workspace");
    let from = choices!(w, (corner_mm, MM), (corner_m, 1.0));
    let to = choices!(w, (opposite_corner_mm, MM), (opposite_corner_m, 1.0));
    let from = need(&place, "corner", &from)?.value;
    let to = need(&place, "opposite corner", &to)?.value;
    Ok(Some((from.into(), to.into())))
}

/// Two opposite corners, m.
pub(crate) type Corners = (Vector3<f64>, Vector3<f64>);
