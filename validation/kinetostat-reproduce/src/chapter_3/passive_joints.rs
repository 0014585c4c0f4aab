//! Effect of passive joints on the stiffness of a link: equation 3.26, Tables 3.1 to 3.3.

use kinetostat::number::larger;
use kinetostat::{
    BeamSection, Chain, Error, MotionKind, Pose,
    reference::{
        Axis, planar_beam, planar_with_hinge_at_end, planar_with_slide_along_x,
        planar_with_slide_along_y, with_hinge_at_end, with_hinge_at_root, with_slide,
    },
    unloaded_stiffness,
};
use nalgebra::{Matrix3, Matrix6, Vector3};

use crate::{Cause, Contents, Item};

/// The report states no link: any section without a symmetry shows the pattern. SI.
const SECTION: BeamSection = BeamSection {
    youngs_modulus: 2.1e11,
    shear_modulus: 8e10,
    area: 6e-4,
    second_moment_y: 3e-8,
    second_moment_z: 7e-8,
    torsion_constant: 9e-8,
};
const LENGTH: f64 = 0.7;

/// The input, in words for notes.
const INPUT: &str = "E = 2.1e11 Pa, G = 8e10 Pa, L = 0.7 m, A = 6e-4 m2, Iy = 3e-8 m4, Iz = 7e-8 m4, J = 9e-8 m4 (chosen: the report names no section).";

/// The link, and where its passive joint is.
#[derive(Clone, Copy)]
enum JointPlace {
    None,
    Root(MotionKind, Axis),
    End(MotionKind, Axis),
}

fn unit(axis: Axis) -> Vector3<f64> {
    match axis {
        Axis::X => Vector3::x(),
        Axis::Y => Vector3::y(),
        Axis::Z => Vector3::z(),
    }
}

/// Stiffness and its rank by general elimination on a chain of the link and its joint.
fn by_elimination(place: JointPlace) -> Result<(Matrix6<f64>, usize), Error> {
    let mut b = Chain::builder("link");
    if let JointPlace::Root(kind, axis) = place {
        b = b.passive("q", kind, unit(axis), 0.0);
    }
    b = b.link("link", &SECTION, LENGTH);
    if let JointPlace::End(kind, axis) = place {
        b = b.passive("q", kind, unit(axis), 0.0);
    }
    let chain = b.build()?;
    let home = chain.home_coordinates();
    let k = unloaded_stiffness(&chain, &Pose::identity(), &home, &[])?;
    Ok((k.cartesian.matrix, k.rank))
}

/// Largest difference of two stiffness matrices, entries referred to the link's diagonal.
fn difference(one: &Matrix6<f64>, other: &Matrix6<f64>) -> Result<f64, Cause> {
    let link = SECTION.cantilever(LENGTH)?;
    let mut most = 0.0_f64;
    for i in 0..6 {
        for j in 0..6 {
            let size = (link[(i, i)] * link[(j, j)]).sqrt();
            most = larger(most, (one[(i, j)] - other[(i, j)]).abs() / size);
        }
    }
    Ok(most)
}

pub(crate) fn eq_3_26() -> Result<Contents, Cause> {
    let (k, _) = by_elimination(JointPlace::None)?;
    let (e, l) = (SECTION.youngs_modulus, LENGTH);
    let (y, z) = (SECTION.second_moment_y, SECTION.second_moment_z);
    let at = |i: usize, j: usize| k[(i - 1, j - 1)];
    let swapped = "erratum 3.26: K55 belongs to bending in the x-z plane, hence I_y, and K66 to I_z: the print has them exchanged (energy of the beam; as printed the matrix can be indefinite).";
    let right = |name: &str, text: &str, value: f64, computed: f64, unit: &str| {
        Item::formula(name, text, value, computed, unit, "")
    };
    let items = vec![
        right("K11", "EA/L", e * SECTION.area / l, at(1, 1), "N/m"),
        right(
            "K22",
            "12EI_z/L^3",
            12.0 * e * z / l.powi(3),
            at(2, 2),
            "N/m",
        ),
        right(
            "K33",
            "12EI_y/L^3",
            12.0 * e * y / l.powi(3),
            at(3, 3),
            "N/m",
        ),
        right(
            "K44",
            "GJ/L",
            SECTION.shear_modulus * SECTION.torsion_constant / l,
            at(4, 4),
            "N m/rad",
        ),
        Item::wrong_formula(
            "K55",
            "4EI_z/L",
            4.0 * e * z / l,
            at(5, 5),
            "N m/rad",
            swapped,
        ),
        Item::wrong_formula(
            "K66",
            "4EI_y/L",
            4.0 * e * y / l,
            at(6, 6),
            "N m/rad",
            swapped,
        ),
        right("K35", "6EI_y/L^2", 6.0 * e * y / l.powi(2), at(3, 5), "N"),
        Item::formula(
            "K26",
            "-6EI_z/L^2",
            -6.0 * e * z / l.powi(2),
            at(2, 6),
            "N",
            INPUT,
        ),
    ];
    Ok(Contents::of(items))
}

/// A printed factor of an entry: the print, its value, row and column from 1.
type Factor = (&'static str, f64, usize, usize);

/// A rule by its name.
type Rule = fn(&Matrix3<f64>) -> Result<Matrix3<f64>, Error>;

/// A row of Table 3.1: the joint, the rule, the eliminated direction, the chain, the print.
type PlanarRow = (&'static str, Rule, Option<usize>, JointPlace, [Factor; 4]);

/// A row of Tables 3.2 and 3.3: the joint, the rule's matrix and the chain, what is left of ENTRIES.
type SpatialRow = (&'static str, (Matrix6<f64>, JointPlace), [&'static str; 8]);

/// Rows of Table 3.1: the joint, the named rule on any matrix and on the beam, and what is printed of the beam
/// in units of EA/L, EI/L^3, EI/L^2, EI/L.
const PLANAR_ROWS: [PlanarRow; 4] = [
    (
        "no joint",
        |k| Ok(*k),
        None,
        JointPlace::None,
        [
            ("1", 1.0, 1, 1),
            ("12", 12.0, 2, 2),
            ("-6", -6.0, 2, 3),
            ("4", 4.0, 3, 3),
        ],
    ),
    (
        "slide along x",
        planar_with_slide_along_x,
        Some(0),
        JointPlace::End(MotionKind::Prismatic, Axis::X),
        [
            ("0", 0.0, 1, 1),
            ("12", 12.0, 2, 2),
            ("-6", -6.0, 2, 3),
            ("4", 4.0, 3, 3),
        ],
    ),
    (
        "slide along y",
        planar_with_slide_along_y,
        Some(1),
        JointPlace::End(MotionKind::Prismatic, Axis::Y),
        [
            ("1", 1.0, 1, 1),
            ("0", 0.0, 2, 2),
            ("0", 0.0, 2, 3),
            ("1", 1.0, 3, 3),
        ],
    ),
    (
        "hinge about z",
        planar_with_hinge_at_end,
        Some(2),
        JointPlace::End(MotionKind::Revolute, Axis::Z),
        [
            ("1", 1.0, 1, 1),
            ("3", 3.0, 2, 2),
            ("0", 0.0, 2, 3),
            ("0", 0.0, 3, 3),
        ],
    ),
];

pub(crate) fn table_3_1() -> Result<Contents, Cause> {
    let (ea, ei) = (
        SECTION.youngs_modulus * SECTION.area,
        SECTION.youngs_modulus * SECTION.second_moment_z,
    );
    let beam = planar_beam(ea, ei, LENGTH)?;
    let mut items = Vec::new();
    for (joint, rule, gone, place, factors) in PLANAR_ROWS {
        if let Some(p) = gone {
            items.push(on_any_link(joint, rule, p)?);
        }
        let (general, _) = by_elimination(place)?;
        let own = rule(&beam)?;
        items.extend(factors.map(|factor| of_the_beam(joint, factor, &own, ea, ei)));
        items.push(against_elimination(joint, &own, &beam, &general));
    }
    Ok(Contents::of(items))
}

/// The printed formula of the general matrices on the left, for a link of no symmetry; `p` is the eliminated direction.
fn on_any_link(joint: &str, rule: Rule, p: usize) -> Result<Item, Cause> {
    let any = Matrix3::new(5.0, 1.2, -0.7, 1.2, 3.0, 0.9, -0.7, 0.9, 2.0);
    let printed = Matrix3::from_fn(|i, j| any[(i, j)] - any[(i, p)] * any[(p, j)] / any[(p, p)]);
    let ours = rule(&any)?;
    let most = (printed - ours).amax();
    let text = format!("K_jk - K_j{0} K_{0}k / K_{0}{0}", p + 1);
    Ok(Item::formula(
        format!("{joint}, any link: largest difference from the printed entries"),
        &text,
        0.0,
        most,
        "",
        "The named rule on a matrix without zeros; all nine entries.",
    ))
}

/// An entry of the beam's matrix as a multiple of its unit.
fn of_the_beam(
    joint: &str,
    (printed, value, i, j): Factor,
    own: &Matrix3<f64>,
    ea: f64,
    ei: f64,
) -> Item {
    let l = LENGTH;
    let measure = match (i, j) {
        (1, 1) => ea / l,
        (2, 2) => ei / l.powi(3),
        (3, 3) => ei / l,
        _ => ei / l.powi(2),
    };
    let measured = match (i, j) {
        (1, 1) => "EA/L",
        (2, 2) => "EI_z/L^3",
        (3, 3) => "EI_z/L",
        _ => "EI_z/L^2",
    };
    Item::formula(
        format!("{joint}, beam: K{i}{j} / ({measured})"),
        printed,
        value,
        own[(i - 1, j - 1)] / measure,
        "",
        "",
    )
}

/// The rule beside the elimination of the joint from a chain.
fn against_elimination(
    joint: &str,
    own: &Matrix3<f64>,
    beam: &Matrix3<f64>,
    general: &Matrix6<f64>,
) -> Item {
    let pick = [0, 1, 5];
    let chain = Matrix3::from_fn(|i, j| general[(pick[i], pick[j])]);
    let most = (0..9)
        .map(|n| {
            let (i, j) = (n / 3, n % 3);
            (chain[(i, j)] - own[(i, j)]).abs() / (beam[(i, i)] * beam[(j, j)]).sqrt()
        })
        .fold(0.0, larger);
    Item::unprinted(
        format!("{joint}: the rule against elimination on a chain, largest difference as a share"),
        most,
        "",
        "",
    )
}

/// Entries of 3.25 that are not zero, and what a joint leaves of each.
const ENTRIES: [(usize, usize); 8] = [
    (1, 1),
    (2, 2),
    (3, 3),
    (4, 4),
    (5, 5),
    (6, 6),
    (2, 6),
    (3, 5),
];

fn value(fraction: &str) -> f64 {
    match fraction {
        "1/4" => 0.25,
        "1/2" => 0.5,
        "3/4" => 0.75,
        "1" => 1.0,
        _ => 0.0,
    }
}

fn compare_table(
    rows: &[(&str, Matrix6<f64>, JointPlace, [&'static str; 8])],
) -> Result<Contents, Cause> {
    let link = SECTION.cantilever(LENGTH)?;
    let mut items = Vec::new();
    for (joint, own, place, printed) in rows {
        let (general, rank) = by_elimination(*place)?;
        for (&(i, j), printed) in ENTRIES.iter().zip(printed) {
            let at = (i - 1, j - 1);
            let name = format!("{joint}: what is left of K{i}{j}");
            let left = own[at] / link[at];
            items.push(Item::formula(name, printed, value(printed), left, "", ""));
        }
        // All other entries stay zero.
        let mut rest = *own;
        for (i, j) in ENTRIES {
            rest[(i - 1, j - 1)] = 0.0;
            rest[(j - 1, i - 1)] = 0.0;
        }
        let zero = Matrix6::zeros();
        items.push(Item::formula(
            format!("{joint}: largest other entry, as a share"),
            "0",
            0.0,
            difference(&rest, &zero)?,
            "",
            "",
        ));
        items.push(Item::unprinted(
            format!("{joint}: rank"),
            rank as f64,
            "",
            "",
        ));
        items.push(Item::unprinted(
            format!(
                "{joint}: the rule against elimination on a chain, largest difference as a share"
            ),
            difference(own, &general)?,
            "",
            INPUT,
        ));
    }
    Ok(Contents::of(items))
}

pub(crate) fn table_3_2() -> Result<Contents, Cause> {
    let k = SECTION.cantilever(LENGTH)?;
    let slide = |axis| -> Result<_, Cause> {
        Ok((
            with_slide(&k, axis)?,
            JointPlace::End(MotionKind::Prismatic, axis),
        ))
    };
    let hinge = |axis| -> Result<_, Cause> {
        Ok((
            with_hinge_at_end(&k, axis)?,
            JointPlace::End(MotionKind::Revolute, axis),
        ))
    };
    // In the order of ENTRIES: K11 K22 K33 K44 K55 K66 K26 K35.
    let rows: [SpatialRow; 6] = [
        (
            "T_x",
            slide(Axis::X)?,
            ["0", "1", "1", "1", "1", "1", "1", "1"],
        ),
        (
            "T_y",
            slide(Axis::Y)?,
            ["1", "0", "1", "1", "1", "1/4", "0", "1"],
        ),
        (
            "T_z",
            slide(Axis::Z)?,
            ["1", "1", "0", "1", "1/4", "1", "1", "0"],
        ),
        (
            "R_x",
            hinge(Axis::X)?,
            ["1", "1", "1", "0", "1", "1", "1", "1"],
        ),
        (
            "R_y",
            hinge(Axis::Y)?,
            ["1", "1", "1/4", "1", "0", "1", "1", "0"],
        ),
        (
            "R_z",
            hinge(Axis::Z)?,
            ["1", "1/4", "1", "1", "1", "0", "0", "1"],
        ),
    ];
    compare_table(&rows.map(|(joint, (own, place), printed)| (joint, own, place, printed)))
}

pub(crate) fn table_3_3() -> Result<Contents, Cause> {
    let k = SECTION.cantilever(LENGTH)?;
    let root = |axis| -> Result<_, Cause> {
        Ok((
            with_hinge_at_root(&k, axis, LENGTH)?,
            JointPlace::Root(MotionKind::Revolute, axis),
        ))
    };
    let rows: [SpatialRow; 2] = [
        (
            "R_y at L",
            root(Axis::Y)?,
            ["1", "1", "1/4", "1", "3/4", "1", "1", "1/2"],
        ),
        (
            "R_z at L",
            root(Axis::Z)?,
            ["1", "1/4", "1", "1", "1", "3/4", "1/2", "1"],
        ),
    ];
    compare_table(&rows.map(|(joint, (own, place), printed)| (joint, own, place, printed)))
}
