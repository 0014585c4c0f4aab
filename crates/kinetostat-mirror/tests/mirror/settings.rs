//! Settings that a path does not allow: refused in words before anything is computed.

use kinetostat_mirror::{
    MeasureSettings, MeasuredPoints, MirrorState, NominalPath, Stations, measure,
};

use crate::machine::{SHAPE, read, sampled};

/// The path has 300 mm or so: a millionth of a smoothing length to each station is beyond any memory.
#[test]
fn a_smoothing_length_of_nothing_is_refused() {
    let (_, path) = read(SHAPE);
    let nominal = NominalPath::new(&path).unwrap();
    let points = MeasuredPoints::at(&sampled(&path, 300)).unwrap();
    for smoothing_mm in [
        0.0,
        -0.0,
        -5.0,
        1e-300,
        1e-9,
        1e-4,
        1e9,
        f64::NAN,
        f64::INFINITY,
    ] {
        let settings = MeasureSettings {
            smoothing_mm,
            register: kinetostat_mirror::Register::None,
            ..MeasureSettings::default()
        };
        let why = measure(&nominal, &points, &settings).map(|found| found.figures);
        let why = why.unwrap_err().to_string();
        let begins = format!("the smoothing length is {smoothing_mm} mm; this path of ");
        assert!(why.starts_with(&begins), "{why}");
        assert!(MirrorState::new(&nominal, "abc", settings).is_err());
        // What the message names is allowed, and half of the least or twice the most is not.
        let named = why.split("lengths from ").last().unwrap();
        let named = named.trim_end_matches(" times its own");
        let (least, times) = named.split_once(" mm to ").unwrap();
        let [least, times] = [least, times].map(|x| x.parse::<f64>().unwrap());
        let most = times * nominal.length_mm();
        assert!(Stations::of(&nominal, least).is_ok(), "{why}");
        assert!(Stations::of(&nominal, 0.5 * least).is_err(), "{why}");
        assert!(Stations::of(&nominal, most).is_ok(), "{why}");
        assert!(Stations::of(&nominal, 2.0 * most).is_err(), "{why}");
    }
}
