//! Broken files: each refused in words that name the file, what is wrong and what to do; nothing panics.

use std::fmt::Write as _;

use kinetostat_links::{
    CondensationRequest, Nodes, Result, Text, Tie, Units, condense, identify, read_displacements,
    read_loads, read_matrix, read_nodes, read_superelement, unit_loads,
};
use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;

use crate::at_least;

fn n_mm() -> Units {
    Units::named("n_mm").expect("known")
}

fn matrix(body: &[u8]) -> Result<()> {
    read_matrix(&Text::new("broken", body)?, None).map(|_| ())
}

fn element(body: &[u8]) -> Result<()> {
    read_superelement(&Text::new("broken", body)?, None, None).map(|_| ())
}

fn sti(body: &str, dofs: &str) -> Result<()> {
    read_superelement(
        &Text::new("broken", body)?,
        Some(&Text::new("broken.dof", dofs)?),
        None,
    )
    .map(|_| ())
}

fn table(body: &str) -> Result<()> {
    let text = Text::new("broken", body)?;
    let cases = read_displacements(&text, &unit_loads(1.0, 1.0), None, None)?;
    identify(text.name(), &cases, &Vector3::zeros()).map(|_| ())
}

fn nodes(body: &str) -> Result<()> {
    read_nodes(&Text::new("broken", body)?, n_mm()).map(|_| ())
}

/// Six rows of a matrix with one cell changed.
fn rows(change: impl Fn(usize, usize) -> Option<&'static str>) -> String {
    let mut out = String::from("stiffness_n_mm_rad,x,y,z,rx,ry,rz\n");
    for (i, name) in ["x", "y", "z", "rx", "ry", "rz"].iter().enumerate() {
        out += name;
        for j in 0..6 {
            let plain = if i == j { "1e6" } else { "0" };
            let _ = write!(out, ",{}", change(i, j).unwrap_or(plain));
        }
        out += "\n";
    }
    out
}

fn displacement_table(change: impl Fn(usize, usize) -> Option<&'static str>) -> String {
    let mut out = String::from("case,node,x_mm,y_mm,z_mm,ux_mm,uy_mm,uz_mm\n");
    for (c, case) in ["fx", "fy", "fz", "mx", "my", "mz"].iter().enumerate() {
        for n in 0..4 {
            match change(c, n) {
                Some(line) => out += line,
                None => {
                    let _ = write!(
                        out,
                        "{case},{n},{},{},0,1e-3,2e-3,{c}e-3",
                        10 * (n % 2),
                        10 * (n / 2)
                    );
                }
            }
            out += "\n";
        }
    }
    out
}

const HEAD: &str = "DMIG    KAAX           0       6       2       0\n";

#[test]
fn broken_files_are_refused_in_words() {
    let plain = |_: usize, _: usize| None;
    let long = "9".repeat(1 << 16);
    let cases: Vec<(&str, Result<()>, &str)> = vec![
        // Any file.
        ("empty", matrix(b""), "empty"),
        ("binary", matrix(b"\x89PNG\x00\x01"), "binary"),
        ("UTF-16", matrix(b"\xff\xfe1\x00"), "UTF-16"),
        ("Latin-1", matrix(b"source,Kr\xfcger\n"), "line 1"),
        ("65 MB", matrix(&vec![b'1'; (64 << 20) + 1]), "64 MB"),
        // 6 x 6 matrices.
        ("no header", matrix(b"1,0,0,0,0,0\n0,1,0,0,0,0\n"), "units are unknown"),
        ("unknown unit", matrix(rows(plain).replace("n_mm", "n_cm").as_bytes()), "no key"),
        ("degrees", matrix(rows(plain).replace("_rad", "_deg").as_bytes()), "no key"),
        ("nan", matrix(rows(|i, j| (i == 2 && j == 4).then_some("nan")).as_bytes()), "row z column ry"),
        ("overflow", matrix(rows(|i, j| (i == 2 && j == 4).then_some("1e400")).as_bytes()), "line 4"),
        ("decimal comma", matrix(rows(|i, j| (i == 1 && j == 1).then_some("1,5")).as_bytes()), "7 numbers"),
        ("text", matrix(rows(|i, j| (i == 0 && j == 0).then_some("=A1*2")).as_bytes()), "no finite number"),
        ("five columns", matrix(rows(plain).replacen(",0", "", 1).as_bytes()), "line 2"),
        ("five rows", matrix(rows(plain).lines().take(6).collect::<Vec<_>>().join("\n").as_bytes()), "after 5 rows"),
        ("row twice", matrix(rows(plain).replace("\nrz", "\nry").as_bytes()), "written twice"),
        ("column twice", matrix(rows(plain).replacen(",rz", ",ry", 1).as_bytes()), "ry twice"),
        ("unknown direction", matrix(rows(plain).replace("\nrz", "\nrw").as_bytes()), "no direction"),
        ("two matrices", matrix((rows(plain) + &rows(plain)).as_bytes()), "second matrix"),
        ("axes", matrix(format!("x_axis,1,0,0\ny_axis,2,0,0\n{}", rows(plain)).as_bytes()), "span no frame"),
        ("zero axis", matrix(format!("x_axis,0,0,0\n{}", rows(plain)).as_bytes()), "span no frame"),
        ("point", matrix(format!("reference_point_mm,1,2\n{}", rows(plain)).as_bytes()), "three numbers"),
        ("compliance", matrix(rows(|i, j| (i == 3 && j == 3).then_some("0")).replace("stiffness", "compliance").as_bytes()), "cannot be inverted"),
        ("JSON cut off", matrix(b"{\"stiffness_n_mm_rad\": [[1,2"), "line 1"),
        ("JSON key", matrix(b"{\"stiffnes_n_mm_rad\": []}"), "unknown field"),
        ("JSON rows", matrix(b"{\"stiffness_n_mm_rad\": [[1,2,3,4,5,6]]}"), "line 1"),
        ("JSON deep", matrix("[".repeat(100_000).as_bytes()), "line 1"),
        ("JSON nothing", matrix(b"{}"), "no matrix"),
        ("long number", matrix(rows(|i, j| (i + j == 0).then_some("x")).replace('x', &long).as_bytes()), "; "),
        // Superelements.
        ("prose", element(b"these are no numbers at all\n"), "none of the formats"),
        ("DMIG without header", element(b"DMIG    KAAX           1       1               1       1 1.0\n"), "no header"),
        ("DMIG complex", element(HEAD.replace("       2       0", "       4       0").as_bytes()), "type 4"),
        ("DMIG rectangular", element(HEAD.replace("       6", "       9").as_bytes()), "form 9"),
        ("DMIG component", element(format!("{HEAD}DMIG    KAAX           1       7               1       1 1.0\n").as_bytes()), "line 2"),
        ("DMIG value", element(format!("{HEAD}DMIG    KAAX           1       1               1       1 1.0e++\n").as_bytes()), "no finite number"),
        ("DMIG both halves", element(format!("{HEAD}DMIG    KAAX           1       1               1       2 1.0\nDMIG    KAAX           1       2               1       1 1.0\n").as_bytes()), "both halves"),
        ("DMIG twice", element(format!("{HEAD}DMIG    KAAX           1       1               1       1 1.0\nDMIG    KAAX           1       1               1       1 2.0\n").as_bytes()), "twice"),
        ("DMIG second header", element(format!("{HEAD}{HEAD}").as_bytes()), "second header"),
        ("DMIG only a header", element(HEAD.as_bytes()), "no entries"),
        ("DMIG two stiffnesses", element(format!("{HEAD}{}", HEAD.replace("KAAX", "KBBX")).as_bytes()), "--matrix"),
        ("DMIG imaginary", element(format!("{HEAD}DMIG    KAAX           1       1               1       1 1.0     2.0\n").as_bytes()), "imaginary"),
        ("mtx cut off", element(b"*USER ELEMENT,NODES= 1,LINEAR\n** ELEMENT NODES\n** 5,\n1,2,3\n*MATRIX,TYPE=STIFFNESS\n1.,\n2., 3.,\n"), "3 entries, 3 degrees of freedom need 6"),
        ("mtx without nodes", element(b"*USER ELEMENT,NODES= 1,LINEAR\n1,2\n*MATRIX,TYPE=STIFFNESS\n1.,\n"), "nodes"),
        ("mtx unsymmetric", element(b"*USER ELEMENT,NODES=1,LINEAR,UNSYMM\n"), "unsymmetric"),
        ("mtx direction", element(b"*USER ELEMENT,NODES= 1\n** ELEMENT NODES\n** 5,\n9\n*MATRIX,TYPE=STIFFNESS\n1.,\n"), "from 1 to 6"),
        ("sti alone", element(b"1 1 1.0\n2 2 1.0\n"), "--dofs"),
        ("sti beyond its list", sti("1 1 1.0\n3 3 1.0\n", "1.1\n1.2\n"), "one run"),
        ("sti fields", sti("1 1 1.0\n2 2\n", "1.1\n1.2\n"), "line 2"),
        ("dof twice", sti("1 1 1.0\n", "1.1\n1.1\n"), "listed twice"),
        ("dof line", sti("1 1 1.0\n", "one.1\n"), "broken.dof, line 1"),
        ("pairs", element(b"1,1,1,1,1.0\n1,8,1,1,1.0\n"), "line 2"),
        ("Harwell-Boeing pattern", element(b"t\n1 1 1 1 0\nPSA 1 1 1 0\n(8I10) (8I10) (3D25.16)\n"), "PSA"),
        // Nodes.
        ("nodes prose", nodes("nothing here\n"), "no nodes"),
        ("nodes twice", nodes("*NODE\n1,0,0,0\n1,1,0,0\n"), "line 3"),
        ("nodes nan", nodes("node,x_mm,y_mm,z_mm\n1,0,nan,0\n"), "no finite number"),
        ("nodes system", nodes("GRID    1       3       0.0     0.0     0.0\n"), "coordinate system"),
        ("set bomb", nodes("*NODE\n1,0,0,0\n*NSET,NSET=A,GENERATE\n1,99999999999,1\n"), "far too many"),
        // Displacement tables.
        ("five cases", table(&displacement_table(|c, _| (c == 5).then_some("mx,9,1,1,1,0,0,0"))), "twice"),
        ("unknown case", table(&displacement_table(|c, n| (c == 2 && n == 0).then_some("f3,0,0,0,0,0,0,0"))), "'f3'"),
        ("missing column", table("case,x_mm,y_mm,z_mm,ux_mm,uy_mm\n"), "'uz' is missing"),
        ("unit missing", table("case,x,y,z,ux,uy,uz\n"), "'x' is not known"),
        ("no rows", table("case,node,x_mm,y_mm,z_mm,ux_mm,uy_mm,uz_mm\n"), "no rows"),
        ("moved node", table(&displacement_table(|c, n| (c == 2 && n == 0).then_some("fz,0,5,0,0,0,0,0"))), "lies elsewhere"),
        ("nan displacement", table(&displacement_table(|c, n| (c == 2 && n == 0).then_some("fz,0,0,0,0,nan,0,0"))), "line 10"),
        ("same answer to all loads", table(&displacement_table(|_, _| None)), "singular"),
        ("loads twice", Text::new("broken", "case,fx_n\na,1\nA,2\n").and_then(|t| read_loads(&t)).map(|_| ()), "twice"),
        ("loads unit", Text::new("broken", "case,fx_lbf\na,1\n").and_then(|t| read_loads(&t)).map(|_| ()), "not known"),
    ];
    let count = cases.len();
    for (name, found, word) in cases {
        let error = found
            .err()
            .unwrap_or_else(|| panic!("'{name}' was accepted"));
        let words = error.to_string();
        assert!(
            words.contains(word),
            "'{name}': '{word}' is not in: {words}"
        );
        assert!(
            words.starts_with("broken") && !error.help.is_empty() && words.len() < 900,
            "{name}: {words}"
        );
    }
    at_least(
        "broken matrix and displacement files refused in words",
        count,
        12,
        "files",
    );
}

#[test]
fn requests_that_the_matrix_cannot_answer() {
    let body = "1,1,1,1,5.0\n1,2,1,2,5.0\n1,3,1,3,5.0\n2,1,2,1,5.0\n2,2,2,2,5.0\n2,3,2,3,5.0\n3,1,3,1,-1.0\n";
    let k = read_superelement(&Text::new("k", body).expect("text"), None, None).expect("matrix");
    let ask = |interface: &[u64], fixed: &[u64]| {
        let request = CondensationRequest {
            units: n_mm(),
            interface: interface.to_vec(),
            fixed: fixed.to_vec(),
            end: None,
            axes: Rotation3::identity(),
            tie: Tie::Rigid,
        };
        condense(&k, &Nodes::default(), &request)
            .expect_err("refused")
            .to_string()
    };
    for (words, wanted) in [
        (ask(&[], &[2]), "no nodes"),
        (ask(&[1], &[1]), "both interfaces"),
        (ask(&[9], &[2]), "node 9 of the interface"),
        (ask(&[1], &[9]), "node 9 that shall be fixed"),
        (ask(&[1, 2], &[]), "place of the node 1 is unknown"),
        (ask(&[1], &[2]), "3 of 6 motions"),
    ] {
        assert!(words.contains(wanted), "'{wanted}' is not in: {words}");
    }
    // Inside: negative, and loose.
    let six: String = (1..=6).map(|d| format!("1,{d},1,{d},5.0\n")).collect();
    for (extra, wanted) in [
        ("2,1,2,1,-1.0\n", "nothing holds"),
        (
            "2,1,2,1,4.0\n2,2,2,1,8.0\n2,2,2,2,4.0\n",
            "not positive definite",
        ),
    ] {
        let k = read_superelement(
            &Text::new("k", six.clone() + extra).expect("text"),
            None,
            None,
        )
        .expect("matrix");
        let request = CondensationRequest {
            units: n_mm(),
            interface: vec![1],
            fixed: vec![],
            end: None,
            axes: Rotation3::identity(),
            tie: Tie::Rigid,
        };
        let words = condense(&k, &Nodes::default(), &request)
            .expect_err("refused")
            .to_string();
        assert!(words.contains(wanted), "'{wanted}' is not in: {words}");
    }
}

#[test]
fn files_that_are_not_there_or_too_large() {
    let here = std::env::temp_dir().join(format!("kinetostat-links-{}", std::process::id()));
    assert!(
        Text::read(&here)
            .expect_err("none")
            .message
            .contains("does not exist")
    );
    std::fs::create_dir_all(&here).expect("folder");
    assert!(
        Text::read(&here)
            .expect_err("folder")
            .message
            .contains("directory")
    );
    // 200 MB on paper; nothing of it is read.
    let large = here.join("large.sti");
    std::fs::File::create(&large)
        .and_then(|f| f.set_len(200 << 20))
        .expect("file");
    assert!(
        Text::read(&large)
            .expect_err("large")
            .message
            .contains("64 MB")
    );
    std::fs::remove_dir_all(&here).expect("removed");
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]

    /// Whatever is cut out of or put into a good file, the readers answer or refuse.
    #[test]
    fn readers_never_panic(at in 0.0..1.0_f64, length in 0..60_usize, put in "[-+0-9eED.,;* \n\"a-zA-Z$é]{0,24}") {
        let bulk: String = include_str!("../../data/frame.bdf").lines().take(60).collect::<Vec<_>>().join("\n");
        let good = [
            rows(|_, _| None),
            displacement_table(|_, _| None),
            bulk,
            "*USER ELEMENT,NODES= 2,LINEAR\n** ELEMENT NODES\n** 5, 6,\n1,2\n2,1\n*MATRIX,TYPE=STIFFNESS\n1.,\n2.,3.,\n1.,2.,3.,\n".to_owned(),
            "t\n5 1 1 1 0\nRSA 2 2 3 0\n(8I3) (8I3) (3D12.3)\n  1  3  4\n  1  2  2\n 1.0E0 1.0E0 2.0E0\n".to_owned(),
            "1 1 1.0\n1 2 0.5\n2 2 1.0\n".to_owned(),
            "{\"stiffness_n_mm_rad\": [[1,2,3,4,5,6]]}".to_owned(),
            "*NODE\n1,0,0,0\n2,1,2,3\n*NSET,NSET=A\n1,2\n".to_owned(),
        ];
        let dofs = Text::new("dof", "1.1\n1.2\n 1 1 UX\n").expect("text");
        for body in good {
            let mut bytes: Vec<char> = body.chars().collect();
            let from = ((bytes.len() as f64) * at) as usize;
            let to = (from + length).min(bytes.len());
            bytes.splice(from..to, put.chars());
            let Ok(text) = Text::new("mutated", bytes.into_iter().collect::<String>()) else { continue };
            let _ = read_matrix(&text, Some(n_mm()));
            let _ = read_loads(&text);
            if let Ok(mesh) = read_nodes(&text, n_mm()) {
                let _ = mesh.named("A");
            }
            if let Ok(cases) = read_displacements(&text, &unit_loads(1.0, 1.0), None, None) {
                let _ = identify("mutated", &cases, &Vector3::zeros());
            }
            for companion in [None, Some(&dofs)] {
                if let Ok(k) = read_superelement(&text, companion, None) {
                    let _ = kinetostat_links::free_test(&k, &Nodes::default(), n_mm());
                    let request = CondensationRequest { units: n_mm(), interface: vec![5], fixed: vec![6], end: None, axes: Rotation3::identity(), tie: Tie::Rigid };
                    let _ = condense(&k, &Nodes::default(), &request);
                }
            }
        }
    }
}
