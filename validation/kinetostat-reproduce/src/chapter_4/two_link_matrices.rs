//! Tables 4.1 and 4.2: the printed Jacobians and Hessians of the two-link chains, entry by entry, at
//! a posture without symmetry.

use kinetostat::{Chain, Error, Pose, Wrench, model::Kinematics};
use nalgebra::{DMatrix, Matrix6xX, Vector3};

use crate::shared::models::{ALPHA0, elastic_links_of, rigid_links_of};
use crate::{Cause, Contents, Item};

/// Lengths of the links, forces on the middle and on the end.
const L1: f64 = 1.0;
const L2: f64 = 0.8;
const G: [f64; 2] = [0.35, -0.6];
const F: [f64; 2] = [-0.9, 0.45];

/// Jacobians of middle and end and Hessians of G and of F at a posture.
struct Blocks {
    middle: Matrix6xX<f64>,
    end: Matrix6xX<f64>,
    of_g: DMatrix<f64>,
    of_f: DMatrix<f64>,
}

fn blocks(chain: &Chain, x: &[f64]) -> Result<Blocks, Error> {
    let k = Kinematics::new(chain, &Pose::identity(), x, &[]);
    let (middle, end) = (chain.node("middle")?, chain.tip());
    let force = |f: [f64; 2]| Wrench::new(Vector3::new(f[0], f[1], 0.0), Vector3::zeros());
    Ok(Blocks {
        middle: k.jacobian(middle),
        end: k.jacobian(end),
        of_g: k.hessian(&[(middle, force(G))]),
        of_f: k.hessian(&[(end, force(F))]),
    })
}

/// Rows x, y and rotation of a planar Jacobian.
const ROWS: [usize; 3] = [0, 1, 5];

/// Adds one column: print and its value for each row.
fn column(
    items: &mut Vec<Item>,
    name: &str,
    jacobian: &Matrix6xX<f64>,
    index: usize,
    printed: [(&str, f64); 3],
    note: &str,
) {
    for (k, (text, value)) in printed.into_iter().enumerate() {
        let own = jacobian[(ROWS[k], index)];
        let name = format!("{name}, row {}", k + 1);
        items.push(Item::wrong_formula(name, text, value, own, "", note));
    }
}

fn entry(items: &mut Vec<Item>, name: &str, printed: (&str, f64), own: f64, note: &str) {
    items.push(Item::wrong_formula(
        name, printed.0, printed.1, own, "", note,
    ));
}

/// Notes only where print and model differ.
fn tidy(mut items: Vec<Item>, input: &str) -> Contents {
    for item in &mut items {
        if item.status == crate::Status::Agrees {
            item.note.clear();
        }
    }
    if let Some(first) = items.first_mut()
        && first.note.is_empty()
    {
        input.clone_into(&mut first.note);
    }
    Contents::of(items)
}

pub(crate) fn table_4_1() -> Result<Contents, Cause> {
    let (q1, theta, q2) = (0.4_f64, -0.7_f64, 0.2_f64);
    let b = blocks(&rigid_links_of(L1, L2)?, &[q1, theta, q2])?;
    let (s1, c1) = q1.sin_cos();
    let (s2, c2) = (q1 + theta).sin_cos();
    let mut items = Vec::new();
    let i = &mut items;
    column(
        i,
        "J_th^(G)",
        &b.middle,
        1,
        [("0", 0.0), ("0", 0.0), ("1", 1.0)],
        "erratum Table 4.1 J_th^(G): g_a does not contain theta, the column is zero.",
    );
    column(
        i,
        "J_q^(G), q1",
        &b.middle,
        0,
        [("-L1 sin q1", -L1 * s1), ("L1 cos q1", L1 * c1), ("1", 1.0)],
        "",
    );
    column(
        i,
        "J_q^(G), q2",
        &b.middle,
        2,
        [("0", 0.0), ("0", 0.0), ("1", 1.0)],
        "erratum Tables 4.1, 4.2 J_q^(G)[3,:]: the last row is [1 0], q2 turns the end, not the node.",
    );
    column(
        i,
        "J_th^(F)",
        &b.end,
        1,
        [
            ("-L2 sin(q1+th)", -L2 * s2),
            ("-L2 cos(q1+th)", -L2 * c2),
            ("1", 1.0),
        ],
        "erratum Table 4.1 J_th^(F)[2]: the second entry is +L2 cos(q1 + th).",
    );
    column(
        i,
        "J_q^(F), q1",
        &b.end,
        0,
        [
            ("-L1 sin q1 - L2 sin(q1+th)", -L1 * s1 - L2 * s2),
            ("L1 cos q1 + L2 cos(q1+th)", L1 * c1 + L2 * c2),
            ("1", 1.0),
        ],
        "",
    );
    column(
        i,
        "J_q^(F), q2",
        &b.end,
        2,
        [("0", 0.0), ("0", 0.0), ("1", 1.0)],
        "",
    );
    let h2 = -L2 * c2 * F[0] - L2 * s2 * F[1];
    let h3 = -(L1 * c1 + L2 * c2) * F[0] - (L1 * s1 + L2 * s2) * F[1];
    let (g, f) = (&b.of_g, &b.of_f);
    entry(
        i,
        "h1 = H_qq^(G), q1 q1",
        ("-L1 sin q1 G_y", -L1 * s1 * G[1]),
        g[(0, 0)],
        "erratum Table 4.1 h1: h1 = -L1 (cos q1 G_x + sin q1 G_y); the print holds for G_x = 0 only.",
    );
    entry(i, "H_thth^(G)", ("0", 0.0), g[(1, 1)], "");
    entry(i, "H_thq^(G), q1", ("0", 0.0), g[(1, 0)], "");
    let text = "-L2 cos(q1+th) F_x - L2 sin(q1+th) F_y";
    entry(i, "h2 = H_thth^(F)", (text, h2), f[(1, 1)], "");
    entry(i, "h2 = H_thq^(F), q1", (text, h2), f[(1, 0)], "");
    entry(
        i,
        "h3 = H_qq^(F), q1 q1",
        (
            "-(L1 cos q1 + L2 cos(q1+th)) F_x - (L1 sin q1 + L2 sin(q1+th)) F_y",
            h3,
        ),
        f[(0, 0)],
        "",
    );
    entry(i, "H_qq^(F), q2 q2", ("0", 0.0), f[(2, 2)], "");
    Ok(tidy(
        items,
        "At L1 = 1, L2 = 0.8, q1 = 0.4, theta = -0.7, q2 = 0.2, G = (0.35, -0.6), F = (-0.9, 0.45); q2 does not matter.",
    ))
}

/// Arguments of Table 4.2: `q1`, `theta1` to `theta3`, `q2`.
const CONFIGURATION_4_2: [f64; 5] = [0.4, 0.05, -0.7, -0.03, 0.2];

pub(crate) fn table_4_2() -> Result<Contents, Cause> {
    let chain = elastic_links_of(L1, L2, ALPHA0)?;
    let b = blocks(&chain, &CONFIGURATION_4_2)?;
    let mut items = Vec::new();
    jacobians_4_2(&mut items, &b);
    hessians_4_2(&mut items, &b);
    Ok(tidy(
        items,
        "At L1 = 1, L2 = 0.8, q1 = 0.4, theta = (0.05, -0.7, -0.03), q2 = 0.2, G = (0.35, -0.6), F = (-0.9, 0.45). The title says rigid links: it is the case of compliant ones.",
    ))
}

/// Columns of the Jacobians of node and end.
fn jacobians_4_2(i: &mut Vec<Item>, b: &Blocks) {
    let [q1, t1, t2, t3, _] = CONFIGURATION_4_2;
    let (s1, c1) = q1.sin_cos();
    let (s2, c2) = (q1 + t2).sin_cos();
    let (l1, l2) = (L1 + t1, L2 + t3);
    let (j1, j2, j3, j4) = (c1, s1, -l1 * s1, l1 * c1);
    let (j5, j6, j7, j8) = (-l2 * s2, l2 * c2, c2, s2);
    let zero = [("0", 0.0), ("0", 0.0), ("0", 0.0)];
    column(
        i,
        "J_th^(G), theta1",
        &b.middle,
        1,
        [("j1", j1), ("j2", j2), ("0", 0.0)],
        "",
    );
    column(i, "J_th^(G), theta2", &b.middle, 2, zero, "");
    column(i, "J_th^(G), theta3", &b.middle, 3, zero, "");
    column(
        i,
        "J_q^(G), q1",
        &b.middle,
        0,
        [("j3", j3), ("j4", j4), ("1", 1.0)],
        "",
    );
    column(
        i,
        "J_q^(G), q2",
        &b.middle,
        4,
        [("0", 0.0), ("0", 0.0), ("1", 1.0)],
        "erratum Tables 4.1, 4.2 J_q^(G)[3,:]: the last row is [1 0], q2 turns the end, not the node.",
    );
    column(
        i,
        "J_th^(F), theta1",
        &b.end,
        1,
        [("j1", j1), ("j2", j2), ("0", 0.0)],
        "",
    );
    column(
        i,
        "J_th^(F), theta2",
        &b.end,
        2,
        [("j5", j5), ("j6", j6), ("1", 1.0)],
        "",
    );
    column(
        i,
        "J_th^(F), theta3",
        &b.end,
        3,
        [("j7", j7), ("j8", j8), ("0", 0.0)],
        "",
    );
    column(
        i,
        "J_q^(F), q1",
        &b.end,
        0,
        [("j3 + j5", j3 + j5), ("j4 + j6", j4 + j6), ("1", 1.0)],
        "",
    );
    column(
        i,
        "J_q^(F), q2",
        &b.end,
        4,
        [("0", 0.0), ("0", 0.0), ("1", 1.0)],
        "",
    );
}

/// Entries of the Hessians of the loads on node and end.
fn hessians_4_2(i: &mut Vec<Item>, b: &Blocks) {
    let [q1, t1, t2, t3, _] = CONFIGURATION_4_2;
    let (s1, c1) = q1.sin_cos();
    let (s2, c2) = (q1 + t2).sin_cos();
    let (l1, l2) = (L1 + t1, L2 + t3);
    let h1 = -G[0] * s1 + G[1] * c1;
    let h2 = -G[0] * l1 * c1 - G[1] * l1 * s1;
    let h3 = -F[0] * l2 * c2 - F[1] * l2 * s2;
    let h4 = -F[0] * s2 + F[1] * c2;
    let h5 = -F[0] * s1 + F[1] * c1;
    let h6 = h3 - F[0] * l1 * c1 - F[1] * l1 * s1;
    let (g, f) = (&b.of_g, &b.of_f);
    for (name, printed, own) in [
        ("H_thq^(G), theta1 q1", ("h1", h1), g[(1, 0)]),
        ("H_qq^(G), q1 q1", ("h2", h2), g[(0, 0)]),
        ("H_thth^(G), theta1 theta1", ("0", 0.0), g[(1, 1)]),
        ("H_thth^(F), theta2 theta2", ("h3", h3), f[(2, 2)]),
        ("H_thth^(F), theta2 theta3", ("h4", h4), f[(2, 3)]),
        ("H_thth^(F), theta1 theta1", ("0", 0.0), f[(1, 1)]),
        ("H_thth^(F), theta3 theta3", ("0", 0.0), f[(3, 3)]),
        ("H_thth^(F), theta1 theta2", ("0", 0.0), f[(1, 2)]),
        ("H_thq^(F), theta1 q1", ("h5", h5), f[(1, 0)]),
        ("H_thq^(F), theta2 q1", ("h3", h3), f[(2, 0)]),
        ("H_thq^(F), theta3 q1", ("h4", h4), f[(3, 0)]),
        ("H_qq^(F), q1 q1", ("h6", h6), f[(0, 0)]),
        ("H_qq^(F), q2 q2", ("0", 0.0), f[(4, 4)]),
    ] {
        entry(i, name, printed, own, "");
    }
}

pub(crate) fn text_4_4() -> Result<Contents, Cause> {
    // A chain of n_q passive coordinates and n_theta springs: the sizes of the systems of 4.15, 4.16.
    let (passive, springs) = (2_usize, 20_usize);
    let note = "erratum 4.4 text: \"3-link manipulator with two passive and two actuated joints\": three links of six springs and two drives, n_theta = 20, n_q = 2 give 6 + n_q + n_theta = 28 and 6 + n_q = 8; the printed pair needs n_q = 8.";
    let items = vec![
        Item::erratum(
            "size of the matrix to be inverted, 4.15",
            "34",
            (6 + passive + springs) as f64,
            "",
            note,
        ),
        Item::erratum(
            "size of the matrix to be inverted, 4.16",
            "14",
            (6 + passive) as f64,
            "",
            note,
        ),
    ];
    Ok(Contents::of(items))
}
