//! Rotations of springs: three turns one after the other, and the rotation vector that they make.

use nalgebra::{Rotation3, Vector3};

use crate::linalg::derivatives::{Number, inner, outer};

/// Rotation vector of `Rx(a) Ry(b) Rz(c)`, from half angles.
#[inline(always)]
pub(crate) fn rotation_vector<N: Number>(turns: &[N; 3]) -> [N; 3] {
    let (sa, ca) = (turns[0] * 0.5).sin_cos_of_spring();
    let (sb, cb) = (turns[1] * 0.5).sin_cos_of_spring();
    let (sc, cc) = (turns[2] * 0.5).sin_cos_of_spring();
    let mut v = [
        (sa * cb).times_plus(cc, ca * sb * sc),
        (ca * sb).times_plus(cc, -(sa * cb * sc)),
        (ca * cb).times_plus(sc, sa * sb * cc),
    ];
    // The shorter one of the two vectors of a rotation.
    if (ca * cb * cc - sa * sb * sc).is_negative() {
        v = [-v[0], -v[1], -v[2]];
    }
    let ratio = inner(&v, &v).angle_per_sine() * 2.0;
    [v[0] * ratio, v[1] * ratio, v[2] * ratio]
}

/// Torques in the three turns from those (`m`) by the rotation vector (`f`, of the given square): the transposed
/// rate of the logarithm, `m + f x m / 2 + c f x (f x m)`, on the three axes of the turns.
#[inline(always)]
pub(crate) fn torque_on_turns<N: Number>(
    turns: &[N; 3],
    f: &[N; 3],
    square: N,
    m: &[N; 3],
) -> [N; 3] {
    let [c, _] = square.logarithm_factor();
    let once = outer(f, m);
    let twice = outer(f, &once);
    let mut about = *m;
    for k in 0..3 {
        about[k] = c.times_plus(twice[k], m[k] + once[k] * 0.5);
    }
    let ((sx, cx), (sy, cy)) = (turns[0].sin_cos_of_spring(), turns[1].sin_cos_of_spring());
    let third = [sy, -(sx * cy), cx * cy];
    [
        about[0],
        cx.times_plus(about[1], sx * about[2]),
        inner(&third, &about),
    ]
}

/// Angles of `Rx(rx) Ry(ry) Rz(rz)` with a given rotation vector.
pub(crate) fn angles(turn: &Vector3<f64>) -> Vector3<f64> {
    let r = Rotation3::from_scaled_axis(*turn);
    Vector3::new(
        (-r[(1, 2)]).atan2(r[(2, 2)]),
        r[(0, 2)].clamp(-1.0, 1.0).asin(),
        (-r[(0, 1)]).atan2(r[(0, 0)]),
    )
}
