//! Superelements: the formats, condensation, rigid-body test; against numpy and closed forms.

use kinetostat::BeamSection;
use kinetostat_links::{
    CondensationRequest, Nodes, SYMMETRIC_TO, Superelement, Text, Tie, Units, check_stiffness,
    condense, free_test, read_nodes, read_superelement,
};
use kinetostat_testing::Worst;
use nalgebra::{DMatrix, Matrix3, Matrix6, Rotation3, Vector3};
use serde_json::Value;

use crate::{apart, at_most, text};

fn n_mm() -> Units {
    Units::named("n_mm").expect("known")
}

fn condensation(interface: &[u64], fixed: &[u64]) -> CondensationRequest {
    CondensationRequest {
        units: n_mm(),
        interface: interface.to_vec(),
        fixed: fixed.to_vec(),
        end: None,
        axes: Rotation3::identity(),
        tie: Tie::Rigid,
    }
}

fn frame() -> (Text, Nodes, Superelement) {
    let bulk = text("frame.bdf", include_str!("../../data/frame.bdf"));
    let nodes = read_nodes(&bulk, n_mm()).expect("nodes");
    let element = read_superelement(&bulk, None, None).expect("matrix");
    (bulk, nodes, element)
}

/// A 12 x 12 of a free beam along x (N, mm) from the 6 x 6 of its cantilever by equilibrium alone.
fn free_beam() -> (DMatrix<f64>, Matrix6<f64>) {
    let si = BeamSection::tube(2.1e11, 8.0e10, 0.06, 0.04)
        .cantilever(0.4)
        .expect("a section");
    let k = kinetostat_links::in_n_mm(&si);
    let mut shift = Matrix6::identity();
    shift
        .fixed_view_mut::<3, 3>(0, 3)
        .copy_from(&-Vector3::new(400.0, 0.0, 0.0).cross_matrix());
    let mut whole = DMatrix::zeros(12, 12);
    whole.view_mut((6, 6), (6, 6)).copy_from(&k);
    whole.view_mut((6, 0), (6, 6)).copy_from(&(-k * shift));
    whole
        .view_mut((0, 6), (6, 6))
        .copy_from(&(-shift.transpose() * k));
    whole
        .view_mut((0, 0), (6, 6))
        .copy_from(&(shift.transpose() * k * shift));
    (whole, si)
}

#[test]
fn a_space_frame_from_dmig_agrees_with_numpy() {
    let (_, nodes, element) = frame();
    assert_eq!(
        (
            element.dofs.len(),
            nodes.places.len(),
            element.name.as_str()
        ),
        (42, 7, "KAAX")
    );
    let golden: Value =
        serde_json::from_str(include_str!("../../data/frame.json")).expect("golden");
    let rows = |name: &str| -> Vec<Vec<f64>> {
        serde_json::from_value(golden[name].clone()).expect("rows")
    };
    let matrix = |name: &str| n_mm().stiffness_to_si(&Matrix6::from_fn(|i, j| rows(name)[i][j]));
    let axes = rows("axes");
    let axes = Rotation3::from_matrix_unchecked(Matrix3::from_fn(|i, j| axes[i][j]));
    let end: Vec<f64> = serde_json::from_value(golden["end_mm"].clone()).expect("end");
    let mut request = condensation(&[5, 6, 7], &[1, 2]);
    request.axes = axes;
    request.end = Some(Vector3::from_column_slice(&end) * 1e-3);
    let found = condense(&element, &nodes, &request).expect("condensed");
    assert_eq!(found.counts, [18, 12, 12]);
    at_most(
        "space frame of 7 nodes by DMIG, rigid spider, against numpy",
        apart(&found.stiffness, &matrix("rigid_5_6_7_n_mm_rad")),
        1e-9,
        "of the diagonal",
    );
    let mut request = condensation(&[5], &[1, 2]);
    request.axes = axes;
    let found = condense(&element, &nodes, &request).expect("condensed");
    assert!(apart(&found.stiffness, &matrix("node_5_n_mm_rad")) < 1e-9);
    assert!(
        check_stiffness(&found.stiffness, SYMMETRIC_TO)
            .findings
            .is_empty()
    );
}

#[test]
fn the_rigid_body_test_finds_six_zero_modes_and_supports() {
    let (_, nodes, element) = frame();
    let free = free_test(&element, &nodes, n_mm());
    assert!(free.is_free(), "{}", free.words());
    assert_eq!((free.zero_modes, free.negative_modes), (Some(6), Some(0)));
    // 12 x 12 of a beam.
    let (whole, _) = free_beam();
    let beam = read_superelement(
        &text("beam.mtx", &user_element(&whole, &[(1, 6), (2, 6)])),
        None,
        None,
    )
    .expect("beam");
    let free = free_test(&beam, &Nodes::default(), n_mm());
    assert_eq!(free.zero_modes, Some(6));
    assert_eq!(free.resistance[3], None, "places are unknown");
    // A spring to the ground at node 2 along y.
    let mut held = whole;
    held[(7, 7)] *= 1.01;
    let held = read_superelement(
        &text("held.mtx", &user_element(&held, &[(1, 6), (2, 6)])),
        None,
        None,
    )
    .expect("beam");
    let free = free_test(&held, &Nodes::default(), n_mm());
    assert!(
        !free.is_free() && free.zero_modes == Some(5),
        "{}",
        free.words()
    );
    assert!(free.words().contains("along y"));
}

/// As CalculiX and Abaqus write it: nodes with their number of directions, lower half.
fn user_element(k: &DMatrix<f64>, nodes: &[(u64, usize)]) -> String {
    let mut out = format!(
        "**\n** GENERATION OF SUBSTRUCTURE\n*USER ELEMENT,NODES={:10},LINEAR\n** ELEMENT NODES\n**",
        nodes.len()
    );
    for (n, _) in nodes {
        out += &format!("{n:10},");
    }
    out += "\n";
    for (i, (_, count)) in nodes.iter().enumerate() {
        if i > 0 {
            out += &format!("{:10},", i + 1);
        }
        let list: Vec<String> = (1..=*count).map(|d| d.to_string()).collect();
        out += &format!("{}\n", list.join(","));
    }
    out += "*MATRIX,TYPE=STIFFNESS\n";
    for i in 0..k.nrows() {
        for j in 0..=i {
            out += &format!(
                "{:20.13e},{}",
                k[(i, j)],
                if j % 4 == 3 || j == i { "\n" } else { "" }
            );
        }
    }
    out
}

/// The same 12 x 12 in every format gives the same 6 x 6.
#[test]
fn every_format_says_the_same_of_a_beam() {
    let (k, si) = free_beam();
    let at = |i: usize| (i as u64 / 6 + 1, i % 6 + 1);
    let mut small =
        String::from("$ small fields\nDMIG    KAAX           0       6       2       0\n");
    let mut free = String::from("DMIG, KSQ, 0, 1, 2, 0\n");
    let mut pairs = String::from("** node, dof, node, dof, value\n");
    let (mut sti, mut dof) = (String::new(), String::new());
    let (mut pointers, mut rows, mut values, mut map) = (
        vec![1],
        Vec::new(),
        Vec::new(),
        String::from(" Matrix Eqn  Node  DOF\n"),
    );
    for j in 0..12 {
        let (n, d) = at(j);
        dof += &format!("{n}.{d}\n");
        map += &format!(
            "{:10}{n:10}    {}\n",
            j + 1,
            ["UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ"][d - 1]
        );
        small += &format!("DMIG    KAAX    {n:8}{d:8}        ");
        free += &format!("DMIG, KSQ, {n}, {d}, ");
        let mut first = true;
        for i in 0..12 {
            let (m, e) = at(i);
            let v = k[(i, j)];
            free += &format!("{}, {m}, {e}, {v:e}, ", if first { "" } else { "\n+" });
            first = false;
            if i < j {
                continue;
            }
            // Small fields have eight columns: the test's beam is rounded to what fits.
            let short =
                format!("{v:.2e}").replace("e", if v.abs() >= 1.0 || v == 0.0 { "+" } else { "" });
            small += &format!(
                "{}{m:8}{e:8}{short:>8}        ",
                if i == j { "" } else { "\n+       " }
            );
            pairs += &format!("{m:10},{e:5},{n:10},{d:5},{v:20.13e}\n");
            sti += &format!("{} {} {v:20.13e}\n", j + 1, i + 1);
            rows.push(i + 1);
            values.push(v);
        }
        pointers.push(values.len() + 1);
        small += "\n";
        free += "\n";
    }
    let lines = |cells: Vec<String>, per: usize| -> Vec<String> {
        cells.chunks(per).map(<[String]>::concat).collect()
    };
    let p = lines(pointers.iter().map(|x| format!("{x:10}")).collect(), 8);
    let r = lines(rows.iter().map(|x| format!("{x:10}")).collect(), 8);
    let v = lines(values.iter().map(|x| format!("{x:25.16e}")).collect(), 3);
    let hb = format!(
        "beam\n{:14}{:14}{:14}{:14}{:14}\nRSA           {:14}{:14}{:14}{:14}\n(8I10)          (8I10)          (1P,3D25.16)        \n{}\n{}\n{}\n",
        p.len() + r.len() + v.len(),
        p.len(),
        r.len(),
        v.len(),
        0,
        12,
        12,
        values.len(),
        0,
        p.join("\n"),
        r.join("\n"),
        v.join("\n")
    );
    let dofs = text("beam.dof", &dof);
    let mapping = text("beam.mapping", &map);
    let cases: [(&str, &str, Option<&Text>, f64); 5] = [
        ("free DMIG", &free, None, 1e-12),
        ("pairs.mtx", &pairs, None, 1e-12),
        ("beam.sti", &sti, Some(&dofs), 1e-12),
        ("beam.matrix", &hb, Some(&mapping), 1e-12),
        (
            "user.mtx",
            &user_element(&k, &[(1, 6), (2, 6)]),
            None,
            1e-12,
        ),
    ];
    let mut worst = Worst::new();
    for (name, body, companion, tolerance) in cases {
        let element = read_superelement(&text(name, body), companion, None)
            .unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(element.dofs.len(), 12);
        let found = condense(&element, &Nodes::default(), &condensation(&[2], &[1]))
            .unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(
            apart(&found.stiffness, &si) < tolerance,
            "{name}: {}",
            apart(&found.stiffness, &si)
        );
        worst.add(apart(&found.stiffness, &si));
    }
    at_most(
        "12 x 12 of a beam in five formats",
        worst.of(5),
        1e-12,
        "of the diagonal",
    );
    let element = read_superelement(&text("small DMIG", &small), None, None).expect("small fields");
    let found =
        condense(&element, &Nodes::default(), &condensation(&[2], &[1])).expect("condensed");
    assert!(
        apart(&found.stiffness, &si) < 6e-3,
        "three digits: {}",
        apart(&found.stiffness, &si)
    );
}

/// The spider about an end away from the nodes, translations only: a plate of springs by hand.
#[test]
fn a_spider_over_translations_is_the_sum_of_its_springs() {
    let places = [
        [0.0, 10.0, 0.0],
        [0.0, -10.0, 5.0],
        [0.0, 0.0, -20.0],
        [3.0, 12.0, 12.0],
    ];
    let springs = [
        [1e3, 2e3, 3e3],
        [4e3, 5e3, 6e3],
        [7e3, 1e3, 2e3],
        [3e3, 3e3, 1e3],
    ];
    let mut mesh = String::from("node,x_mm,y_mm,z_mm\n");
    let mut pairs = String::new();
    let end = Vector3::new(25.0, -4.0, 7.0);
    let mut wanted = Matrix6::zeros();
    for (n, (p, k)) in places.iter().zip(springs).enumerate() {
        mesh += &format!("{},{},{},{}\n", n + 1, p[0], p[1], p[2]);
        let arm = Vector3::from(*p) - end;
        for d in 0..3 {
            pairs += &format!("{},{},{},{},{}\n", n + 1, d + 1, n + 1, d + 1, k[d]);
            let axis = Vector3::ith(d, 1.0);
            let turn = arm.cross(&axis);
            let line = nalgebra::Vector6::new(axis.x, axis.y, axis.z, turn.x, turn.y, turn.z);
            wanted += k[d] * line * line.transpose();
        }
    }
    let nodes = read_nodes(&text("mesh.csv", &mesh), n_mm()).expect("nodes");
    let element = read_superelement(&text("k.mtx", &pairs), None, None).expect("matrix");
    let mut request = condensation(&[1, 2, 3, 4], &[]);
    request.end = Some(end * 1e-3);
    let found = condense(&element, &nodes, &request).expect("condensed");
    assert!(apart(&found.stiffness, &n_mm().stiffness_to_si(&wanted)) < 1e-13);
    // Two nodes hold five motions: named.
    let error = condense(&element, &nodes, &condensation(&[1, 2], &[3]))
        .expect_err("a line")
        .to_string();
    assert!(
        error.contains("5 of 6") && error.contains("one line"),
        "{error}"
    );
}

/// Nodes on springs of their own: tied rigidly the springs work side by side, averaged their
/// compliances are averaged: `C = A diag(1/k) A^T` by hand, and never stiffer.
#[test]
fn an_averaged_interface_averages_compliances() {
    let places = [
        [0.0, 10.0, 10.0],
        [0.0, -10.0, 10.0],
        [0.0, -10.0, -10.0],
        [0.0, 10.0, -10.0],
    ];
    let nodes: String = places
        .iter()
        .enumerate()
        .map(|(n, p)| format!("{},{},{},{}\n", n + 1, p[0], p[1], p[2]))
        .collect();
    let mesh = format!("node,x_mm,y_mm,z_mm\n{nodes}");
    let nodes = read_nodes(&text("mesh.csv", &mesh), n_mm()).expect("nodes");
    let with = |springs: &[f64; 4], tie: Tie, end: Vector3<f64>| {
        let mut pairs = String::new();
        for (n, k) in springs.iter().enumerate() {
            for d in 1..=3 {
                pairs += &format!("{0},{d},{0},{d},{k}\n", n + 1);
            }
        }
        let element = read_superelement(&text("k.mtx", &pairs), None, None).expect("matrix");
        let mut request = condensation(&[1, 2, 3, 4], &[]);
        request.end = Some(end);
        request.tie = tie;
        condense(&element, &nodes, &request)
            .expect("condensed")
            .stiffness
    };
    let uneven = [1e3, 2e3, 4e3, 8e3];
    let c = with(&uneven, Tie::Averaged, Vector3::zeros())
        .try_inverse()
        .expect("regular");
    // A square of half side a = 10 mm: along x the mean of four, 1/16 of the sum of 1/k; about x each node
    // carries a quarter of m / (2 a^2) times its arm; about y and z m / (4 a).
    let sum: f64 = uneven.iter().map(|k| 1e-3 / k).sum();
    let a: f64 = 0.01;
    for (i, wanted) in [
        (0, sum / 16.0),
        (1, sum / 16.0),
        (2, sum / 16.0),
        (3, 2.0 * a * a * sum / (8.0 * a * a).powi(2)),
        (4, sum / (4.0 * a).powi(2)),
        (5, sum / (4.0 * a).powi(2)),
    ] {
        assert!(
            (c[(i, i)] / wanted - 1.0).abs() < 1e-12,
            "{i}: {} {wanted}",
            c[(i, i)]
        );
    }
    for end in [Vector3::zeros(), Vector3::new(0.3, -0.1, 0.05)] {
        // Equal springs: both ties say the same.
        let one = with(&[5e3; 4], Tie::Averaged, end);
        let other = with(&[5e3; 4], Tie::Rigid, end);
        assert!(apart(&one, &other) < 1e-10, "{}", apart(&one, &other));
        // Uneven ones: softer in every direction.
        let less = with(&uneven, Tie::Rigid, end) - with(&uneven, Tie::Averaged, end);
        let unit = with(&uneven, Tie::Rigid, end).diagonal().map(f64::sqrt);
        let scaled = Matrix6::from_fn(|i, j| less[(i, j)] / unit[i] / unit[j]);
        let least = scaled.symmetric_eigenvalues().min();
        assert!(least > -1e-9, "{least}");
        assert!(scaled.symmetric_eigenvalues().max() > 0.1);
    }
    // Two nodes have no average rotation about their line.
    let pairs = "1,1,1,1,1\n1,2,1,2,1\n1,3,1,3,1\n2,1,2,1,1\n2,2,2,2,1\n2,3,2,3,1\n";
    let element = read_superelement(&text("k.mtx", pairs), None, None).expect("matrix");
    let mut request = condensation(&[1, 2], &[]);
    request.tie = Tie::Averaged;
    let error = condense(&element, &nodes, &request)
        .expect_err("a line")
        .to_string();
    assert!(error.contains("average needs three nodes"), "{error}");
}

#[test]
fn meshes_of_calculix_with_sets() {
    let mesh = text(
        "mesh.inp",
        "*Heading\n*NODE, NSET=ALL\n1, 0, 0, 0\n2, 1.5, 0, 0\n3, 3, 0, 0.\n*NSET,NSET=Tip\n2, 3,\n*NSET, NSET=RANGE, GENERATE\n1, 3, 2\n*NSET,NSET=BOTH\nTIP, RANGE\n",
    );
    let nodes = read_nodes(&mesh, n_mm()).expect("mesh");
    assert_eq!(nodes.places[&2], Vector3::new(1.5e-3, 0.0, 0.0));
    assert_eq!(nodes.named("tip").expect("set"), [2, 3]);
    assert_eq!(nodes.named("RANGE").expect("set"), [1, 3]);
    assert_eq!(nodes.named("both").expect("set"), [1, 2, 3]);
    assert_eq!(nodes.named("3, 1").expect("list"), [1, 3]);
    let error = nodes.named("root").expect_err("none").to_string();
    assert!(error.contains("TIP"), "{error}");
}
