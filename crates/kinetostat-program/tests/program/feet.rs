//! Places of a path that are nearest to a point.

use kinetostat_program::{NominalPath, Program, ReadOptions, interpret};
use nalgebra::Vector3;

/// A plunge that goes on in nearly the same direction where a load has come, and a cut across behind it.
const PLUNGE: &str = "G21 G90\nG0 X-19.795 Y-19.841 Z1\nG1 X-19.7958 Y-19.8441 Z-0.303 F300\nG1 Y-19.844 Z-1.1443\nG1 X-19.5148 Y-19.9294 Z-1.1425\n";

/// Coordinates that are added up from increments end in other digits than those that are stated. A corner has a foot for a point at
/// itself nevertheless.
#[test]
fn a_point_that_is_a_corner_but_for_rounding_has_a_foot_there() {
    let path = interpret(&Program::read(PLUNGE).unwrap(), &ReadOptions::default()).unwrap();
    let nominal = NominalPath::new(&path).unwrap();
    let first = (0.0008_f64.powi(2) + 0.0031_f64.powi(2) + 1.303_f64.powi(2)).sqrt();
    let second = (0.0001_f64.powi(2) + 0.8413_f64.powi(2)).sqrt();
    let corners = [
        (Vector3::new(-19.7958, -19.8441, -0.303), first),
        (Vector3::new(-19.7958, -19.844, -1.1443), first + second),
    ];
    let digits = |x: f64| [x.next_down(), x, x.next_up()];
    for (corner, along) in corners {
        for x in digits(corner.x) {
            for y in digits(corner.y) {
                for z in digits(corner.z) {
                    let feet = nominal.nearest_within(&Vector3::new(x, y, z), 0.02);
                    assert!(!feet.is_empty(), "{x} {y} {z}");
                    for foot in feet {
                        assert!((foot.along_mm - along).abs() < 1e-9, "{foot:?}");
                        assert!(foot.distance_mm < 1e-9, "{foot:?}");
                    }
                }
            }
        }
    }
}
