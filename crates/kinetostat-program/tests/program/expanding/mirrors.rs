//! G50, G50.1 and what is mirrored: the axes that end, the side of the tool, the sense of arcs and of turns.

use kinetostat_program::{Curve, Dialect, Path};

use super::fanuc::{BEGIN, run};

fn path(text: &str) -> Path {
    let mut options = kinetostat_program::ExpandOptions::default();
    options.dialect = Dialect::Fanuc;
    let made = kinetostat_program::expand(
        format!("{BEGIN}{text}"),
        &options,
        &kinetostat_program::NoSubprograms,
    );
    made.unwrap_or_else(|error| panic!("{error}\n{text}")).path
}

fn last(text: &str) -> [f64; 3] {
    let end = path(text).moves.last().unwrap().end;
    [end.x, end.y, end.z]
}

/// The words of G50.1 name axes; their numbers mean nothing, and nothing moves.
#[test]
fn g50_1_takes_the_mirrors_of_its_axes_away() {
    let begin = "G51.1 X0 Y0\nG1 X10 Y5\n";
    assert_eq!(path(begin).moves.len(), 2);
    // No move by the block itself; then each axis as it is.
    assert_eq!(path(&format!("{begin}G50.1 X0\n")).moves.len(), 2);
    for (ending, expected) in [
        ("G50.1 X0", [7.0, -3.0]),
        ("G50.1 X99 (X)", [7.0, -3.0]),
        ("G50.1 Y0", [-7.0, 3.0]),
        ("G50.1 X0 Y0", [7.0, 3.0]),
        ("G50.1", [7.0, 3.0]),
        ("G50.1 Z0", [-7.0, -3.0]),
        ("G50.1 X0\nG50.1 Y0", [7.0, 3.0]),
    ] {
        let [x, y, _] = last(&format!("{begin}{ending}\nG1 X7 Y3\n"));
        assert_eq!([x, y], expected, "{ending}");
    }
    // Nothing is in force.
    assert_eq!(path("G50.1 X0\nG50\n").moves.len(), 1);
    // The first line of many programs.
    let begin = "G17 G40 G49 G50 G50.1 G69 G80 G90\nG1 X3\n";
    assert_eq!(last(begin)[0], 3.0);
    // The place stays: X counts from it.
    assert_eq!(last("G51.1 X0\nG1 X10\nG50.1 X0\nG91 G1 X1\n")[0], -9.0);
}

#[test]
fn what_ends_another_thing_or_may_move_is_refused() {
    for (text, needle) in [
        ("G50 X0\n", "sets the coordinates of a lathe"),
        ("G51 X0 Y0 P2.\nG1 X1 Y1\nG50 X0\n", "lathe"),
        ("G51.1 X0\nG1 X1\nG50\n", "mirrors of G51.1 are in force"),
        ("G51 X0 P2.\nG1 X1 Y1\nG50.1\n", "scale of G51 is in force"),
        ("G51.1 X0\nG1 X1\nG50.1 G1 X5\n", "in one block"),
        ("G50.1 X0 A5\n", "in one block"),
        ("G51 I-1.\nG68 X0 Y0 R30\n", "negative factor"),
    ] {
        for dialect in [Dialect::Fanuc, Dialect::Undecided] {
            let error = run(text, dialect).unwrap_err();
            assert!(error.reason.contains(needle), "{text}: {error}");
        }
    }
}

/// Ends, and the senses and centres of arcs, mirrored at X = 0.
fn mirrored(path: &Path) -> Vec<[f64; 6]> {
    let each = path.moves.iter().skip(1).map(|one| {
        let (sweep, centre) = match one.curve {
            Curve::Arc(arc) => (arc.sweep, [arc.centre.x, arc.centre.y]),
            Curve::Line => (0.0, [0.0; 2]),
        };
        let end = one.end;
        [-end.x, end.y, end.z, -sweep, -centre[0], centre[1]]
    });
    each.collect()
}

fn as_it_is(path: &Path) -> Vec<[f64; 6]> {
    let mirrored = mirrored(path).into_iter();
    mirrored
        .map(|[x, y, z, sweep, a, b]| [-x, y, z, -sweep, -a, b])
        .collect()
}

fn near(made: &[[f64; 6]], expected: &[[f64; 6]]) {
    assert_eq!(made.len(), expected.len(), "{made:?}\n{expected:?}");
    for (a, b) in made.iter().zip(expected) {
        for (a, b) in a.iter().zip(b) {
            assert!((a - b).abs() < 1e-9, "{made:?}\n{expected:?}");
        }
    }
}

#[test]
fn a_mirrored_program_is_the_mirror_image() {
    let contour = "G0 X0 Y-20\nG1 Z0\nG41.1 D6 G1 X0 Y0\nY30\nG2 X10 Y40 R10\nG1 X25\nG3 X35 Y50 I0 J10\nG1 Y70\nG40 G1 X60\nG0 Z9\n";
    let other = contour.replace("G41.1", "G42.1");
    let turned = "G68 X5 Y2 R30\nG0 X20 Y8\nG1 X17 Y3\nG3 X20 Y18 R12\nG69\n";
    let both = format!("G68 X5 Y2 R-20\n{contour}G69\n");
    for text in [contour, &other, turned, &both] {
        let expected = mirrored(&path(text));
        near(
            &as_it_is(&path(&format!("G51.1 X0\n{text}G50.1\n"))),
            &expected,
        );
    }
    for text in [contour, &other] {
        let scaled = format!("G51 X0 Y0 Z0 I-1. J1. K1.\n{text}G50\n");
        near(&as_it_is(&path(&scaled)), &mirrored(&path(text)));
    }
    // Both axes: half a turn, the side stays.
    let image = mirrored(&path(contour));
    let image: Vec<[f64; 6]> = image
        .iter()
        .map(|[x, y, z, sweep, a, b]| [*x, -y, *z, -sweep, *a, -b])
        .collect();
    near(
        &as_it_is(&path(&format!("G51.1 X0 Y0\n{contour}G50.1\n"))),
        &image,
    );
    // By hand: the contour goes up beside X = 0 on its left, 3 beside it; the mirrored tool is 3 to its right.
    let made = path(&format!("G51.1 X0\n{contour}"));
    assert!(made.moves.iter().any(|one| (one.end.x - 3.0).abs() < 1e-9));
    assert!(!made.moves.iter().any(|one| (one.end.x + 3.0).abs() < 1e-9));
}
