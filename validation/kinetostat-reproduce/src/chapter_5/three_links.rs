//! Three rigid links with two torsion springs, straight (S) or zigzag (Z) at rest [R 5.5.1]: Table
//! 5.1, equations 5.32 to 5.34, 5.41 and 5.42.

use kinetostat::number::larger;
use kinetostat::{
    Chain, ChainProblem, DirectionKind, EndCondition, Equilibrium, Pose, Prescribed, Settings,
    Wrench, equilibria,
    equilibrium::{Bounds, Equilibria, SearchSettings},
    model::Kinematics,
    reference::shape_criterion,
    solve_chain,
};
use nalgebra::{DVector, Matrix3, Vector3};

use crate::shared::models::{displacement_controlled, linked, s_chain, z_at_rest, z_chain};
use crate::{Cause, Contents, Item, Status};

/// All equilibria with the end held at x, springs within half a turn.
pub(crate) fn all(chain: &Chain, x: f64) -> Result<Equilibria, Cause> {
    let settings = SearchSettings::default();
    Ok(equilibria(
        &displacement_controlled(chain, x),
        &Bounds::of(chain),
        &settings,
    )?)
}

/// Row of Table 5.1 for one equilibrium, K = l = 1.
#[derive(Clone, Debug)]
pub(crate) struct ThreeLinkShape {
    /// q, theta1, theta2 and the end hinge, rad.
    pub(crate) angles: Vec<f64>,
    pub(crate) force: f64,
    pub(crate) stiffness: f64,
    pub(crate) s_c: f64,
    pub(crate) share_to_buckling: f64,
    pub(crate) stable: bool,
}

pub(crate) fn shape(problem: &ChainProblem<'_>, e: &Equilibrium) -> Result<ThreeLinkShape, Cause> {
    let criterion = shape_criterion(problem, e, 1.0)?;
    Ok(ThreeLinkShape {
        angles: e.coordinates.clone(),
        force: e.wrench.0[0],
        stiffness: e.stiffness.cartesian.matrix[(0, 0)],
        // The end hinge turns for nothing: one inner freedom, and zero for the hinge.
        s_c: criterion.matrix.trace(),
        share_to_buckling: e.stability.share_to_buckling.unwrap_or(f64::NAN),
        stable: e.stability.stable,
    })
}

/// All shapes with the end held at x, by rising energy.
pub(crate) fn shapes(chain: &Chain, x: f64) -> Result<Vec<ThreeLinkShape>, Cause> {
    let problem = displacement_controlled(chain, x);
    let all = all(chain, x)?;
    let one = |f: &kinetostat::equilibrium::FoundEquilibrium| shape(&problem, &f.equilibrium);
    all.found.iter().map(one).collect()
}

/// The first shape that is wanted.
pub(crate) fn pick(
    shapes: &[ThreeLinkShape],
    what: &str,
    wanted: impl Fn(&ThreeLinkShape) -> bool,
) -> Result<ThreeLinkShape, Cause> {
    let found = shapes.iter().find(|s| wanted(s)).cloned();
    found.ok_or_else(|| Cause::Missing(what.to_owned()))
}

/// The straight chain pressed by `force`: its `S_c` along one motion, and the eigenvalues.
fn straight(force: f64) -> Result<(f64, Vec<f64>, bool), Cause> {
    let chain = linked("straight chain", &[0.0, 0.0]).build()?;
    // Any force keeps the chain straight; the end is free along x for the solver, held when its stability is found.
    let mut problem = displacement_controlled(&chain, 3.0);
    problem.end.prescribed[0] = Prescribed::Wrench;
    problem.end.wrench = Wrench::new(Vector3::new(force, 0.0, 0.0), Vector3::zeros());
    let e = solve_chain(&problem, &Settings::default())?;
    let mut end = EndCondition::pose(Pose::translation(3.0, 0.0, 0.0));
    end.prescribed[5] = Prescribed::Wrench;
    problem.end = end;
    let criterion = shape_criterion(&problem, &e, 1.0)?;
    // In the chain's order (q, th1, th2): the last column of the report's singular vectors.
    let printed = DVector::from_vec(vec![1.0, 0.0, -3.0]) / 10.0_f64.sqrt();
    let v = criterion.basis.transpose() * printed;
    let value = (v.transpose() * &criterion.matrix * &v)[0];
    let rigid =
        e.stiffness.directions.iter().any(|d| {
            d.kind == DirectionKind::Rigid && d.twist.0[0].abs() > 0.99 * d.twist.0.norm()
        });
    Ok((value, criterion.eigenvalues, rigid))
}

fn straight_items(items: &mut Vec<Item>) -> Result<(), Cause> {
    for (name, printed, force, s_c) in [
        ("S stable", "0.5", -0.5, "-0.60"),
        ("S unstable", "2", -2.0, "0.30"),
    ] {
        let (value, eigenvalues, rigid) = straight(force)?;
        items.push(Item::erratum(
            format!("{name}, Delta = 0: F (chosen)"),
            printed,
            force,
            "K/l",
            "erratum Table 5.1 S, Delta=0 (F): compression is negative; +0.5 and +2 would give S_c = -1.20 and -2.10.",
        ));
        items.push(Item {
            name: format!("{name}, Delta = 0: K_C"),
            printed: Some("Inf".into()),
            computed: rigid.then_some(f64::INFINITY),
            unit: "K/l^2".into(),
            status: if rigid {
                Status::Agrees
            } else {
                Status::NotReproduced
            },
            note: "The stiffness names x a rigid direction: the straight chain is locked along it."
                .into(),
        });
        let largest = eigenvalues.last().copied().unwrap_or(f64::NAN);
        items.push(Item::erratum(
            format!("{name}, Delta = 0: S_c (largest eigenvalue)"),
            s_c,
            largest,
            "K",
            "erratum Table 5.1 S, Delta=0 (S_c): the null space has two dimensions, S_c is 2 x 2 and changes sign at F = -1. The print is S_c along the last singular vector only: it calls the straight chain stable up to F = -1.5, although it has buckled.",
        ));
        items.push(Item::compared(
            format!("{name}, Delta = 0: S_c along (0, -3, 1)/sqrt 10 of (th1, th2, q)"),
            s_c,
            value,
            "K",
            "How the print came about.",
        ));
        for (k, value) in eigenvalues.iter().enumerate() {
            items.push(Item::unprinted(
                format!("{name}, Delta = 0: eigenvalue {} of S_c", k + 1),
                *value,
                "K",
                "",
            ));
        }
    }
    Ok(())
}

/// F, K_C and S_c of a cell as printed.
type Cell = [&'static str; 3];

fn triple(
    items: &mut Vec<Item>,
    cell: &str,
    printed: Option<Cell>,
    shape: &ThreeLinkShape,
    make: impl Fn(String, &str, f64, &str) -> Item,
) {
    let values = [
        ("F", shape.force, "K/l"),
        ("K_C", shape.stiffness, "K/l^2"),
        ("S_c", shape.s_c, "K"),
    ];
    for (k, (what, value, unit)) in values.into_iter().enumerate() {
        let name = format!("{cell}: {what}");
        items.push(match printed {
            Some(print) => make(name, print[k], value, unit),
            None => make(name, "", value, unit),
        });
    }
}

pub(crate) fn table_5_1() -> Result<Contents, Cause> {
    let mut items = Vec::new();
    let plain = |name: String, printed: &str, value: f64, unit: &str| {
        Item::compared(name, printed, value, unit, "")
    };
    straight_items(&mut items)?;
    let (s, z) = (s_chain()?, z_chain()?);
    let bent = shapes(&s, 2.8)?;
    let folded = pick(&bent, "the stable S shape", |e| e.stable)?;
    triple(
        &mut items,
        "S stable, Delta = 0.2",
        Some(["-1.03", "0.18", "-0.63"]),
        &folded,
        plain,
    );
    let zigzag = pick(&bent, "the unstable S shape", |e| !e.stable)?;
    triple(
        &mut items,
        "S unstable, Delta = 0.2",
        Some(["-3.11", "0.57", "1.34"]),
        &zigzag,
        plain,
    );

    let home = shapes(&z, z_at_rest())?;
    let rest = pick(&home, "the unloaded Z shape", |e| e.stable)?;
    triple(
        &mut items,
        "Z stable, Delta = 0",
        Some(["0", "16.93", "-0.67"]),
        &rest,
        plain,
    );
    let mirrored = pick(&home, "the mirrored Z shape", |e| !e.stable)?;
    let forgotten = "erratum Table 5.1 Z unstable, Delta=0: the print is the chain without preload (th0 = 0) held at the same place: see the next rows. With the preload the mirrored Z carries this.";
    triple(
        &mut items,
        "Z unstable, Delta = 0",
        Some(["-3.05", "0.53", "1.33"]),
        &mirrored,
        |name, printed, value, unit| Item::erratum(name, printed, value, unit, forgotten),
    );
    let without = shapes(&s, z_at_rest())?;
    let without = pick(&without, "the zigzag without preload", |e| !e.stable)?;
    triple(
        &mut items,
        "Z unstable, Delta = 0, preload forgotten (th0 = 0)",
        Some(["-3.05", "0.53", "1.33"]),
        &without,
        |name, printed, value, unit| {
            Item::compared(name, printed, value, unit, "What the print shows.")
        },
    );

    let pushed = shapes(&z, z_at_rest() - 0.2)?;
    let down = pick(&pushed, "the buckled Z shape", |e| {
        e.stable && e.angles[0] > 0.0
    })?;
    triple(
        &mut items,
        "Z stable, Delta = 0.2",
        Some(["-1.05", "0.21", "-0.35"]),
        &down,
        plain,
    );
    let mirror = pick(&pushed, "its mirror image", |e| {
        e.stable && e.angles[0] < 0.0
    })?;
    items.push(Item::unprinted(
        "Z stable, Delta = 0.2: S_c of the mirror image",
        mirror.s_c,
        "K",
        &format!(
            "The same physical state, another S_c: it depends on the coordinates. The share mu of the way to buckling is {:.10} for both.",
            mirror.share_to_buckling
        ),
    ));
    z_unstable(&mut items, &pushed)?;
    Ok(Contents::of(items))
}

/// The cell that cannot be reproduced, beside the two equilibria that exist.
fn z_unstable(items: &mut Vec<Item>, pushed: &[ThreeLinkShape]) -> Result<(), Cause> {
    let unstable: Vec<&ThreeLinkShape> = pushed.iter().filter(|e| !e.stable).collect();
    let [near, far] = unstable[..] else {
        return Err(Cause::Missing("the two unstable Z shapes".into()));
    };
    let tried = "Tried: every equilibrium of the Z chain at Delta = 0.2 (complete within half a turn of the springs), its mirror image, th0 = 0 at the same place (F = -3.159776), opposite preload, F = -3.03 imposed on the symmetric posture (gives K and S_c, but no equilibrium). Beside it the nearest of the two unstable equilibria that exist.";
    for (what, printed, value, unit) in [
        ("F", "-3.03", near.force, "K/l"),
        ("K_C", "0.81", near.stiffness, "K/l^2"),
        ("S_c", "1.26", near.s_c, "K"),
    ] {
        let name = format!("Z unstable, Delta = 0.2: {what}");
        items.push(Item::compared(name, printed, value, unit, tried));
    }
    for (which, e) in [("symmetric Z", near), ("mirrored Z", far)] {
        let cell = format!("Z unstable, Delta = 0.2, true equilibrium ({which})");
        triple(items, &cell, None, e, |name, _, value, unit| {
            Item::unprinted(name, value, unit, "")
        });
    }
    Ok(())
}

/// The S chain's equilibrium at Delta: arch (stable) or zigzag.
fn bent(chain: &Chain, delta: f64, stable: bool) -> Result<ThreeLinkShape, Cause> {
    let mut problem = displacement_controlled(chain, 3.0 - delta);
    let a = (1.0 - 0.5 * delta).acos();
    problem.posture = if stable {
        vec![a, -a, -a, a]
    } else {
        let b = (delta / 3.0).sqrt();
        vec![0.58 * b, -1.74 * b, 1.74 * b, -0.58 * b]
    };
    shape(&problem, &solve_chain(&problem, &Settings::default())?)
}

const DELTAS: [f64; 3] = [0.2, 0.5, 1.0];

pub(crate) fn eq_5_32() -> Result<Contents, Cause> {
    let chain = s_chain()?;
    let mut items = Vec::new();
    for delta in DELTAS {
        let own = bent(&chain, delta, true)?;
        let a = (1.0 - 0.5 * delta).acos();
        items.push(Item::formula(
            format!("F_S at Delta = {delta}"),
            "K/L phi/sin(phi)",
            a / a.sin(),
            -own.force,
            "K/l",
            "Compression positive here.",
        ));
    }
    Ok(Contents::of(items))
}

pub(crate) fn eq_5_33() -> Result<Contents, Cause> {
    let chain = s_chain()?;
    let mut items = Vec::new();
    for delta in DELTAS {
        let own = bent(&chain, delta, false)?;
        let (q, t) = posture_5_34(delta);
        let right = t * ((q + t).cos() + 2.0 * q.cos()) / t.sin();
        items.push(Item::wrong_formula(
            format!("F_N at Delta = {delta}"),
            "K/L (cos(q + th) + 2 cos(q) th)/sin(th)",
            ((q + t).cos() + 2.0 * q.cos() * t) / t.sin(),
            -own.force,
            "K/l",
            "erratum 5.33: th multiplies the whole bracket, (K/L) th (cos(q + th) + 2 cos q)/sin th. Compression positive here.",
        ));
        items.push(Item::unprinted(
            format!("the corrected equation less the model at Delta = {delta}"),
            right + own.force,
            "K/l",
            "",
        ));
    }
    Ok(Contents::of(items))
}

/// Printed 5.34: q and theta of the zigzag.
fn posture_5_34(delta: f64) -> (f64, f64) {
    let q = ((12.0 - 6.0 * delta + delta * delta) / (12.0 - 4.0 * delta)).acos();
    let t = -(1.0 - 1.5 * delta + 0.25 * delta * delta).acos();
    (q, t)
}

pub(crate) fn eq_5_34() -> Result<Contents, Cause> {
    let chain = s_chain()?;
    let mut items = Vec::new();
    for delta in DELTAS {
        let own = bent(&chain, delta, false)?;
        let (q, t) = posture_5_34(delta);
        items.push(Item::formula(
            format!("q at Delta = {delta}"),
            "arccos((12 - 6D + D^2)/(12 - 4D))",
            q,
            own.angles[0].abs(),
            "rad",
            "",
        ));
        items.push(Item::formula(
            format!("theta at Delta = {delta}"),
            "arccos(1 - 3D/2 + D^2/4)",
            t.abs(),
            own.angles[1].abs(),
            "rad",
            "",
        ));
    }
    Ok(Contents::of(items))
}

/// `J^T J` of a three-link chain at angles, order (th1, th2, q), l = 1.
fn gram(q: f64, t1: f64, t2: f64) -> Result<Matrix3<f64>, Cause> {
    let chain = linked("three links", &[0.0, 0.0]).build()?;
    let k = Kinematics::new(&chain, &Pose::identity(), &[q, t1, t2], &[]);
    let j = k.jacobian(chain.tip());
    let order = [1, 2, 0];
    let column = |i: usize| j.fixed_view::<2, 1>(0, order[i]).into_owned();
    Ok(Matrix3::from_fn(|a, b| column(a).dot(&column(b))))
}

pub(crate) fn eq_5_41() -> Result<Contents, Cause> {
    let (q, t1, t2) = (0.3, -0.7, 0.4);
    let g = gram(q, t1, t2)?;
    let (c1, c2, c12) = (t1.cos(), t2.cos(), (t1 + t2).cos());
    let note = "erratum 5.41: without the factor F_x^2, in the order (th1, th2, q) the matrix is [2+2c2, 1+c2, 2+c1+2c2+c12; ., 1, 1+c2+c12; ., ., 3+2c1+2c2+2c12], c12 = cos(th1 + th2). At q = 0.3, th1 = -0.7, th2 = 0.4.";
    let rows = [
        (1, 1, "3", 3.0, 2.0 + 2.0 * c2),
        (1, 2, "2+cos(th2)", 2.0 + c2, 1.0 + c2),
        (1, 3, "2+cos(th2)", 2.0 + c2, 2.0 + c1 + 2.0 * c2 + c12),
        (2, 2, "2", 2.0, 1.0),
        (2, 3, "1+cos(th2)", 1.0 + c2, 1.0 + c2 + c12),
        (3, 3, "1", 1.0, 3.0 + 2.0 * (c1 + c2 + c12)),
    ];
    let mut items = Vec::new();
    let mut most = 0.0_f64;
    for (i, j, text, printed, corrected) in rows {
        let own = g[(i - 1, j - 1)];
        most = larger(most, (own - corrected).abs());
        let name = format!("J^T J, row {i}, column {j} / l^2");
        items.push(Item::wrong_formula(name, text, printed, own, "", note));
    }
    items.push(Item::unprinted(
        "largest difference of the corrected entries",
        most,
        "",
        "",
    ));
    Ok(Contents::of(items))
}

pub(crate) fn eq_5_42() -> Result<Contents, Cause> {
    // A symmetric zigzag, th1 = -th2, for which 5.42 is written.
    let t = 0.6_f64;
    let g = gram(0.3, -t, t)?;
    let c = t.cos();
    let minors = 0.5 * (g.trace().powi(2) - (g * g).trace());
    let note = "erratum 5.42: J has rank 2 at most, so zero is always a root: lambda (lambda^2 - tr lambda + det(J J^T)) = 0; for th1 = -th2, tr = 8 + 6 c2 and det = 3 sin^2 th2. At th2 = 0.6.";
    let items = vec![
        Item::wrong_formula(
            "product of the roots",
            "3c^3+4c^2-2c-1",
            3.0 * c.powi(3) + 4.0 * c * c - 2.0 * c - 1.0,
            g.determinant(),
            "",
            note,
        ),
        Item::wrong_formula("sum of the roots", "6", 6.0, g.trace(), "", note),
        Item::wrong_formula(
            "sum of the products of two roots",
            "-(6c-2)",
            2.0 - 6.0 * c,
            minors,
            "",
            note,
        ),
        Item::unprinted(
            "8 + 6 c2 less the sum of the roots",
            8.0 + 6.0 * c - g.trace(),
            "",
            "",
        ),
        Item::unprinted(
            "3 sin^2 th2 less the sum of the products of two roots",
            3.0 * t.sin().powi(2) - minors,
            "",
            "",
        ),
    ];
    Ok(Contents::of(items))
}

pub(crate) fn text_5_5_1() -> Result<Contents, Cause> {
    let z = z_chain()?;
    let problem = displacement_controlled(&z, z_at_rest());
    let home = shapes(&z, z_at_rest())?;
    let rest = pick(&home, "the unloaded Z shape", |e| e.stable)?;
    let e = {
        let mut problem = problem.clone();
        problem.posture.clone_from(&rest.angles);
        solve_chain(&problem, &Settings::default())?
    };
    let mirrored = pick(&home, "the mirrored Z shape", |e| !e.stable)?;
    let s = s_chain()?;
    let mut items = vec![
        Item::compared(
            "q of the unloaded Z chain",
            "9.90",
            rest.angles[0].to_degrees(),
            "deg",
            "",
        ),
        Item::compared(
            "theta1 of the unloaded Z chain",
            "-30",
            rest.angles[1].to_degrees(),
            "deg",
            "",
        ),
        Item::compared(
            "theta2 of the unloaded Z chain",
            "30",
            rest.angles[2].to_degrees(),
            "deg",
            "",
        ),
        Item::compared(
            "x of the end of the unloaded Z chain",
            "2.91",
            e.tip.translation.x,
            "l",
            "",
        ),
        Item {
            name: "K_C of an unstable shape: the mirrored Z at Delta = 0".into(),
            printed: Some("positive".into()),
            computed: Some(mirrored.stiffness),
            unit: "K/l^2".into(),
            status: Status::Erratum,
            note: "erratum 5.5.1 text: \"For the unstable configurations K_C is positive\" does not hold for this one. The conclusion holds: the unstable S shape and the symmetric Z past its pitchfork do have K_C > 0, so K_C > 0 does not make a shape stable.".into(),
        },
    ];
    // 5.2.1: minima and maxima of the energy at a held end.
    let two = "erratum 5.2.1 text: 5.2.1 says exactly two minima and two maxima for each Delta. The Z chain has one of each before its pitchfork at Delta = 0.110931613, two of each after it.";
    for (name, chain, x) in [
        ("S chain at Delta = 0.2", &s, 2.8),
        ("Z chain at Delta = 0.05", &z, z_at_rest() - 0.05),
        ("Z chain at Delta = 0.2", &z, z_at_rest() - 0.2),
    ] {
        let found = shapes(chain, x)?;
        let minima = found.iter().filter(|e| e.stable).count();
        for (what, count) in [("minima", minima), ("maxima", found.len() - minima)] {
            items.push(Item::erratum(
                format!("{what} of the energy, {name} (5.2.1)"),
                "2",
                count as f64,
                "",
                two,
            ));
        }
    }
    Ok(Contents::of(items))
}
