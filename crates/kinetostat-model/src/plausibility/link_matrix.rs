//! Signs that a 6 x 6 matrix is not the stiffness of a link at its far end: a nearly free direction, couplings of the
//! wrong end, a size out of proportion.

use kinetostat::number::{larger, short};
use nalgebra::{Matrix6, Vector6};

use crate::problem::{Finding, KeyPath};
use crate::schema::{Document, Element, Stiffness};

const NAMES: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

/// Directions of a link do not differ by more than this.
const NEARLY_FREE: f64 = 1e9;
/// Lengths of links, m.
const SHORTEST: f64 = 1e-3;
const LONGEST: f64 = 10.0;
/// Share `|k_ij| / sqrt(k_ii k_jj)` from which a coupling counts; a cantilever has 0.87.
const COUPLED: f64 = 0.2;
/// A link's centre of stiffness lies within it; this many lengths behind its end is a wrong unit.
const MOST_LENGTHS: f64 = 2.0;

/// Looks at the stiffness `k` of a link: N/m, N/rad, N m/rad at the far end, x along the link from
/// the near to the far end, translations first. `length`: length of the link in m, where it is known.
/// Returns what looks wrong, each with what to do; nothing for a beam, whole or tapered.
///
/// A direction is nearly free where the directions differ by more than 1e9 whatever length makes
/// rotations comparable to translations (1 mm to 10 m, or the length itself). A beam held at its near
/// end has `k_y,rz < 0` and `k_z,ry > 0` at its far end (`-3/(2L)` and `3/(2L)` of `k_rz,rz` and
/// `k_ry,ry` for a uniform one), so that its centre of stiffness, `-k_y,rz / k_y,y` behind the end,
/// lies between its ends.
///
/// ```
/// let bar = kinetostat::BeamSection::tube(2.1e11, 8.0e10, 0.04, 0.0).cantilever(0.5)?;
/// assert!(kinetostat_model::doubts_of_link_matrix(&bar, Some(0.5)).is_empty());
/// # Ok::<(), kinetostat::Error>(())
/// ```
#[must_use]
pub fn doubts_of_link_matrix(k: &Matrix6<f64>, length: Option<f64>) -> Vec<(String, String)> {
    nearly_free(k, length)
        .into_iter()
        .chain(wrong_end(k, length))
        .collect()
}

/// A direction that moves for almost nothing.
fn nearly_free(k: &Matrix6<f64>, length: Option<f64>) -> Option<(String, String)> {
    if k.iter().any(|x| !x.is_finite()) {
        return None;
    }
    let (from, to, steps) = match length {
        Some(length) => (length, length, 1),
        None => (SHORTEST, LONGEST, 17),
    };
    let mut least: Option<(f64, Matrix6<f64>)> = None;
    for i in 0..steps {
        let share = f64::from(i) / f64::from((steps - 1).max(1));
        let unit = from * (to / from).powf(share);
        let scale = Vector6::from_fn(|i, _| if i < 3 { 1.0 } else { 1.0 / unit });
        let own = Matrix6::from_fn(|i, j| 0.5 * (k[(i, j)] + k[(j, i)]) * scale[i] * scale[j]);
        let eigen = own.symmetric_eigenvalues();
        let ratio = match eigen.min() > 0.0 {
            true => eigen.max() / eigen.min(),
            // Rounding of the largest: what it hides is below it.
            false => 1.0 / f64::EPSILON,
        };
        if least.as_ref().is_none_or(|l| ratio < l.0) {
            least = Some((ratio, own));
        }
    }
    let (ratio, own) = least?;
    if ratio <= NEARLY_FREE {
        return None;
    }
    let eigen = own.symmetric_eigen();
    let motion = eigen.eigenvectors.column(eigen.eigenvalues.imin());
    let mut parts: Vec<usize> = (0..6).filter(|&i| motion[i].abs() > 0.3).collect();
    parts.sort_by(|a, b| motion[*b].abs().total_cmp(&motion[*a].abs()));
    let words: Vec<&str> = parts.iter().map(|i| NAMES[*i]).collect();
    let at = parts.first().copied().unwrap_or(0);
    let (own, unit) = match at < 3 {
        true => (k[(at, at)] * 1e-3, "N/mm"),
        false => (k[(at, at)] * 1e3, "N mm/rad"),
    };
    Some((
        format!(
            "the link is nearly free in direction {} ({} {unit}): its directions differ by a factor of {}",
            words.join(", "),
            short(own),
            short(ratio)
        ),
        "a direction that nothing holds is a passive joint of the chain; else check this entry and its unit".into(),
    ))
}

/// Couplings that no link has at its far end.
fn wrong_end(k: &Matrix6<f64>, length: Option<f64>) -> Option<(String, String)> {
    // Distance of the centre of stiffness behind the end, in the planes x-y and x-z.
    let behind = |moves: usize, turns: usize, sign: f64| {
        let (own, about) = (k[(moves, moves)], k[(turns, turns)]);
        let both = own > 0.0 && about > 0.0;
        let strong = both && k[(moves, turns)].abs() > COUPLED * (own * about).sqrt();
        strong.then(|| sign * k[(moves, turns)] / own)
    };
    let (y, z) = (behind(1, 5, -1.0), behind(2, 4, 1.0));
    let reversed = |d: Option<f64>| d.is_some_and(|d| d < 0.0);
    match (reversed(y), reversed(z)) {
        (true, true) => Some((
            "the couplings y, rz and z, ry have the signs of the near end: no link has them at its far end".into(),
            "this looks like the stiffness at the near end, or like an x axis that points backwards: give it at the far end, with x from the near to the far end".into(),
        )),
        (true, false) | (false, true) => {
            let (plane, wanted) = match reversed(y) {
                true => ("y, rz", "negative"),
                false => ("z, ry", "positive"),
            };
            let one_plane = y.is_none() || z.is_none();
            Some((
                format!(
                    "the coupling {plane} has the wrong sign: it is {wanted} at the far end of a link that is held at the other{}",
                    if one_plane { "" } else { "; no beam has one of y, rz and z, ry reversed" }
                ),
                format!("check the sign of the entry {plane} and the direction of the axes"),
            ))
        }
        _ => {
            let length = length?;
            let far = [(y, "y, rz"), (z, "z, ry")]
                .into_iter()
                .filter_map(|(d, plane)| Some((d?, plane)))
                .find(|(d, _)| *d > MOST_LENGTHS * length)?;
            Some((
                format!(
                    "the coupling {} puts the centre of stiffness {:.0} mm behind the end, and the link is {:.0} mm long",
                    far.1,
                    far.0 * 1e3,
                    length * 1e3
                ),
                "check the units of the matrix, the point that it belongs to, and the length".into(),
            ))
        }
    }
}

/// The matrix of a table in N, m; diagonals have no couplings, but directions.
fn in_metres(s: &Stiffness) -> Option<Matrix6<f64>> {
    let of = |rows: &[[f64; 6]; 6], length: f64| {
        Matrix6::from_fn(|i, j| {
            rows[i][j]
                * match (i < 3, j < 3) {
                    (true, true) => 1.0 / length,
                    (false, false) => length,
                    _ => 1.0,
                }
        })
    };
    let diagonal = |d: &[f64; 6]| -> [[f64; 6]; 6] {
        std::array::from_fn(|i| std::array::from_fn(|j| if i == j { d[i] } else { 0.0 }))
    };
    (s.matrix_n_m_rad.as_ref().map(|m| of(m, 1.0)))
        .or_else(|| s.matrix_n_mm_rad.as_ref().map(|m| of(m, 1e-3)))
        .or_else(|| s.diagonal_n_m_rad.as_ref().map(|d| of(&diagonal(d), 1.0)))
        .or_else(|| s.diagonal_n_mm_rad.as_ref().map(|d| of(&diagonal(d), 1e-3)))
}

/// Looks at the matrices of all links of a model.
pub(crate) fn check(document: &Document, warnings: &mut Vec<Finding>) {
    let mut seen: Vec<&str> = Vec::new();
    let elements = document.chain.values().flat_map(|c| &c.elements);
    for element in elements {
        let Element::Link(link) = element else {
            continue;
        };
        let Some(written) = document.stiffness.get(&link.link) else {
            continue;
        };
        let Some(k) = in_metres(written) else {
            continue;
        };
        if seen.contains(&link.link.as_str()) {
            continue;
        }
        seen.push(&link.link);
        let norm = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let length = link
            .length_m
            .or(link.length_mm.map(|l| l * 1e-3))
            .or(link.vector_m.map(norm))
            .or(link.vector_mm.map(|v| norm(v) * 1e-3));
        let place = KeyPath::root().key("stiffness").key(&link.link);
        if let Some((message, help)) = nearly_free(&k, length) {
            warnings.push(Finding::new(&place, message, help));
        }
        // A stiffness that is turned has other couplings.
        if let Some((message, help)) = written
            .along
            .is_none()
            .then(|| wrong_end(&k, length))
            .flatten()
        {
            warnings.push(Finding::new(&place, message, help));
        }
        let largest = (0..3).map(|i| k[(i, i)]).fold(0.0, larger);
        if !(1e3..=1e12).contains(&largest) {
            warnings.push(Finding::new(
                &place,
                format!(
                    "the largest stiffness of this link against a force is {} N/mm; links lie between 1 N/mm and 1e9 N/mm",
                    short(largest * 1e-3)
                ),
                "check the unit in the key: _n_m_rad or _n_mm_rad",
            ));
        }
    }
}
