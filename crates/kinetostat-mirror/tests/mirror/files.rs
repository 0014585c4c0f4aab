//! Files of points and of a state: what is wrong is said with its line.

use kinetostat_mirror::{MeasureSettings, MeasuredPoints, MirrorState, NominalPath};

use crate::machine::{SHAPE, read};

fn refused(text: &str) -> String {
    let error = MeasuredPoints::read("m.csv", text).expect_err("a fault");
    assert_eq!(error.file.as_deref(), Some("m.csv"));
    error.to_string()
}

#[test]
fn faults_of_a_measurement_stand_with_their_line() {
    let rows = "0,0,0\n1,0,0\n2,0,0\n";
    for (text, begins) in [
        ("x_mm,y_mm\n1,2\n".to_owned(), "m.csv:1: no column of z"),
        (
            format!("x,y_mm,z_mm\n{rows}"),
            "m.csv:1: column `x` states no unit",
        ),
        (
            format!("x_ft,y_mm,z_mm\n{rows}"),
            "m.csv:1: column `x_ft` has an unknown unit",
        ),
        (
            format!("x_mm,y_mm,z_mm,x_m\n{rows}"),
            "m.csv:1: column `x_m` stands for something",
        ),
        (
            format!("x_mm,y_mm,depth\n{rows}"),
            "m.csv:1: unknown column `depth`",
        ),
        (
            "x_mm,y_mm,z_mm\n0,0,0\n1,0\n2,0,0\n".to_owned(),
            "m.csv:3: 2 cells under 3 columns",
        ),
        (
            "x_mm,y_mm,z_mm\n0,0,0\n\n#\n1,NaN,0\n2,0,0\n".to_owned(),
            "m.csv:5: y is `NaN`",
        ),
        (
            "x_mm,y_mm,z_mm\n0,0,0\n1,0,0\n".to_owned(),
            "m.csv:3: 2 measured points",
        ),
        (
            "x_m,y_m,z_m\n0,0,0\n5000,0,0\n1,1,1\n".to_owned(),
            "m.csv:3: row 2: the point",
        ),
        (
            "x_mm,y_mm,z_mm,sigma_um\n0,0,0,1\n0,0,1,0\n0,0,2,1\n".to_owned(),
            "m.csv:3: sigma is 0; expected a standard deviation above 0",
        ),
        (
            "x_mm,y_mm,z_mm,sigma_mm\n0,0,0,1\n0,0,1,-1\n0,0,2,1\n".to_owned(),
            "m.csv:3: sigma is -1; expected a standard deviation above 0",
        ),
        (
            "x_mm,y_mm,z_mm,sigma_mm\n0,0,0,1\n0,0,1,NaN\n0,0,2,1\n".to_owned(),
            "m.csv:3: sigma is `NaN`; expected a number",
        ),
        (
            "x_mm,y_mm,z_mm,sigma_mm\n0,0,0,1\n0,0,1,1e-200\n0,0,2,1\n".to_owned(),
            "m.csv:3: row 2: the weight (or 1 / sigma^2, sigma in mm) is inf",
        ),
        (
            "x_mm,y_mm,z_mm,weight\n0,0,0,1\n0,0,1,-2\n0,0,2,1\n".to_owned(),
            "m.csv:3: row 2: the weight (or 1 / sigma^2, sigma in mm) is -2e0",
        ),
        (
            "x_mm,y_mm,z_mm,line\n0,0,0,1.5\n".to_owned(),
            "m.csv:2: line is 1.5",
        ),
        (String::new(), "m.csv:1: 0 measured points"),
    ] {
        let said = refused(&text);
        assert!(said.starts_with(begins), "{said}");
    }
}

#[test]
fn units_weights_and_lines_are_read() {
    let text = "z_in;y_m;x_um;weight;line\n1;0,5;0;1;3\n";
    assert!(refused(text).starts_with("m.csv:2: y is `0,5`"));
    let text = "\u{feff}z_in;y_m;x_um;weight;line\n1;0.5;250;2;3\n0;0;0;1;3\n0;0;1;1;4\n";
    let points = MeasuredPoints::read("m.csv", text).unwrap();
    let first = points.points()[0];
    assert_eq!(first.position_mm.as_slice(), [0.25, 500.0, 25.4]);
    assert_eq!(
        (first.weight, first.program_line, first.line),
        (2.0, Some(3), 2)
    );
}

#[test]
fn a_state_comes_back_and_belongs_to_one_program() {
    let (_, path) = read(SHAPE);
    let nominal = NominalPath::new(&path).unwrap();
    let settings = MeasureSettings::default();
    let state = MirrorState::new(&nominal, "abc", settings).expect("a state");
    let text = toml::to_string(&state).unwrap();
    let back: MirrorState = toml::from_str(&text).unwrap();
    assert_eq!(back, state);
    assert_eq!(back.fits(&nominal, "abc", &settings), Ok(()));
    let of = |sha: &str, settings: &MeasureSettings| {
        back.fits(&nominal, sha, settings).unwrap_err().to_string()
    };
    assert!(of("abd", &settings).starts_with("the state has program_sha256 = abc, this run abd"));
    let other = MeasureSettings {
        smoothing_mm: 6.0,
        ..settings
    };
    assert!(of("abc", &other).starts_with("the state has smoothing_mm = 5, this run 6"));
    let other = MeasureSettings {
        register: kinetostat_mirror::Register::None,
        ..settings
    };
    assert!(of("abc", &other).starts_with("the state has register = rigid, this run none"));
    let mut broken = back.clone();
    broken.correction_mm[3].y = f64::NAN;
    assert!(broken.fits(&nominal, "abc", &settings).is_err());
    broken.correction_mm.pop();
    assert!(broken.fits(&nominal, "abc", &settings).is_err());
}
