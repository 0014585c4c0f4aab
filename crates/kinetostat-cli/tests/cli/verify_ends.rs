//! `verify`: ends of cuts and depths of holes.

// Helpers of tests, which clippy does not count as tests.
#![allow(clippy::unwrap_used)]

use std::path::Path;

use serde_json::{Value, json};

use crate::verify::{JOB, changed, compensated, line_of, number, verified, without_line};

/// A slot and beside it a pecked hole, nearer than corrections are large; what follows it is the hole alone.
const SLOT: &str = "G0 X9.5 Y-8.6 Z10\nG0 Z1\nG1 Z-1 F900\nG1 X29.7 Y-8.2\nG0 Z10\n";
const HOLE: &str = "G0 X29 Y-7.9 Z10\nG0 Z1\nG1 Z-0.85 F900\nG0 Z1\nG0 Z-0.65\nG1 Z-2.6\nG0 Z10\n";

/// The job with a program.
fn with_part(text: &str) -> tempfile::TempDir {
    let here = crate::common::workplace();
    std::fs::write(here.path().join("job.toml"), JOB).unwrap();
    std::fs::write(here.path().join("part.ngc"), text).unwrap();
    here
}

/// The compensated program of cuts, in `out.ngc`.
fn compensated_cuts(cuts: &str) -> tempfile::TempDir {
    let here = with_part(&format!("G21 G90\n{cuts}M2\n"));
    compensated(here.path(), &["--no-header"]);
    here
}

/// The same with the depth of the block in a line less by a length, mm.
fn lifted(text: &str, line: usize, by_mm: f64) -> String {
    let lift = |word: &str| match word.strip_prefix('Z') {
        Some(z) => format!("Z{:.4}", z.parse::<f64>().unwrap() + by_mm),
        None => word.to_owned(),
    };
    let lines = text.lines().enumerate();
    let lines = lines.map(|(index, block)| match index + 1 == line {
        true => block.split(' ').map(lift).collect::<Vec<_>>().join(" "),
        false => block.to_owned(),
    });
    lines.map(|block| block + "\n").collect()
}

/// Line of the last block at feed before the rapid that leaves the place of `HOLE` for good.
fn ground(text: &str) -> usize {
    let lines: Vec<&str> = text.lines().collect();
    lines
        .iter()
        .rposition(|line| line.starts_with("G1"))
        .unwrap()
        + 1
}

fn uncut(found: &Value) -> &Value {
    &found["matched"]["uncut"]
}

#[test]
fn a_hole_is_cut_though_a_slot_nearby_was_cut_before() {
    let here = compensated_cuts(&format!("{SLOT}{HOLE}"));
    let (code, found, said) = verified(here.path(), "out.ngc", &[]);
    assert!(matches!(code, 0 | 4), "{said}");
    assert_eq!(uncut(&found), &json!([]), "{said}");
}

/// What the second visit cuts first, the first visit has cut before; a lift back to near its ground lies there too.
#[test]
fn a_hole_that_is_pecked_twice_is_cut_twice() {
    let here = compensated_cuts(&format!("{HOLE}{SLOT}{HOLE}"));
    let (code, found, said) = verified(here.path(), "out.ngc", &[]);
    assert!(matches!(code, 0 | 4), "{said}");
    assert_eq!(uncut(&found), &json!([]), "{said}");
    // Without the second visit: its blocks are those behind the last rapid to X29.
    let (code, found, said) = changed(here.path(), |text| {
        let lines: Vec<&str> = text.lines().collect();
        let again = lines
            .iter()
            .rposition(|l| l.starts_with("G0 X29 "))
            .unwrap();
        let kept = lines[..again].iter().chain(lines.last());
        kept.map(|line| format!("{line}\n")).collect()
    });
    assert_eq!(code, 3, "{said}");
    assert!(!uncut(&found).as_array().unwrap().is_empty(), "{said}");
}

/// Drilled with a rapid out of the hole, then reamed with a retract at feed.
#[test]
fn a_hole_that_is_left_at_feed_the_second_time_is_cut() {
    let here = compensated_cuts(
        "G0 X12.3 Y-7.4 Z10\nG0 Z2\nG1 Z-6 F200\nG0 Z2\nG1 Z-6 F150\nG1 Z2\nG0 Z10\n",
    );
    let (code, found, said) = verified(here.path(), "out.ngc", &[]);
    assert!(matches!(code, 0 | 4), "{said}");
    assert_eq!(uncut(&found), &json!([]), "{said}");
}

/// Inches are rounded to other digits than millimetres, and both commands allow for them alike.
#[test]
fn a_program_in_inches_has_the_rounding_of_inches() {
    let text = "G20 G90 G17\nG0 X0.3 Y-0.2 Z0.4\nG1 Z-0.0394 F7.9\nG1 X0.9498 Y-0.0849 F47.2\nG1 X1.0113 Y0.2317\nG1 X0.4411 Y0.3093\nG0 Z0.4\nM2\n";
    let here = with_part(text);
    compensated(here.path(), &["--no-header", "--decimals", "3"]);
    let (code, found, said) = verified(here.path(), "out.ngc", &["--decimals", "3"]);
    assert!(matches!(code, 0 | 4), "{said}");
    // Half of a ten thousandth of an inch along three axes, beside what corrections may be off.
    let rounding_mm = 0.5 * 3.0_f64.sqrt() * 25.4e-4;
    let allowed = number(&found, "allowed_mm");
    assert!(
        (rounding_mm..2.0 * rounding_mm).contains(&allowed),
        "{allowed}"
    );
}

/// Where a rectangle closes, the plunge at its beginning is nearer to the end as it is programmed than the compensated end is.
#[test]
fn an_original_in_place_of_a_compensated_program_misses_the_tolerance_only() {
    let text = "G21 G90 G17\nG0 X-30 Y-20 Z5\nG0 Z1\nG1 Z-2 F300\nG1 X30 F600\nG1 Y20\nG1 X-30\nG1 Y-20\nG0 Z5\nM2\n";
    let here = with_part(text);
    let (code, found, said) = verified(here.path(), "part.ngc", &[]);
    assert_eq!(code, 3, "{said}");
    assert_eq!(uncut(&found), &json!([]), "{said}");
    assert_eq!(found["matched"]["extra_cuts"], json!([]), "{said}");
    assert_eq!(found["matched"]["rapids"], json!([]), "{said}");
    let before = number(&found, "max_position_error_of_original_mm");
    let after = number(&found, "max_position_error_mm");
    assert!((after / before - 1.0).abs() < 1e-6, "{before} {after}");
}

/// Passes lie nearer to each other than corrections are large: places of the original are nearer to another pass than to their own.
#[test]
fn a_narrow_raster_that_is_verified_against_itself_cuts_all_of_itself() {
    let pass = |k: u8| {
        let y = 0.5 * f64::from(k);
        format!("G0 X-15 Y{y}\nG0 Z1\nG1 Z-1 F300\nG1 X15 F600\nG0 Z5\n")
    };
    let passes: String = (0..3).map(pass).collect();
    let here = with_part(&format!("G21 G90 G17\nG0 Z5\n{passes}M2\n"));
    let (code, found, said) = verified(here.path(), "part.ngc", &[]);
    assert_eq!(code, 3, "{said}");
    assert_eq!(uncut(&found), &json!([]), "{said}");
    assert_eq!(found["matched"]["extra_cuts"], json!([]), "{said}");
    let before = number(&found, "rms_position_error_of_original_mm");
    let after = number(&found, "rms_position_error_mm");
    assert!((after / before - 1.0).abs() < 1e-3, "{before} {after}");
    assert!(!said.contains("nothing to correct"), "{said}");
}

/// The rapid that leaves the last cut was compared with nothing where it is left out.
#[test]
fn a_tool_that_is_left_in_the_last_cut_is_a_fault() {
    let here = compensated_cuts(SLOT);
    let (code, _, said) = changed(here.path(), |text| {
        let last = text.lines().collect::<Vec<_>>();
        let last = last.iter().rposition(|line| line.starts_with("G0"));
        without_line(text, last.unwrap() + 1)
    });
    assert_eq!(code, 3, "{said}");
    assert!(said.contains("leaves the tool where it cuts"), "{said}");
    // Left at feed, the tool is as far away.
    let (code, _, said) = changed(here.path(), |text| {
        let last = text.rfind("G0 ").unwrap();
        format!("{}G1 {}", &text[..last], &text[last + 3..])
    });
    assert!(matches!(code, 0 | 4), "{said}");
}

/// On a step at a corner the load turns while the tool stands: how far it has turned is known no worse than places elsewhere are.
#[test]
fn steps_at_corners_are_no_farther_off_than_the_program_claims() {
    let text = "G20 G90 G17\nG0 X-0.9707 Y0.5333 Z0.0394\nG1 Z-0.1323 F15.748\nG1 X-1.1691 Y1.0446\nG1 X-1.0714 Y1.0268\nG1 X-1.1349 Y1.0269\nG1 X-0.6508 Y0.8626\nG0 Z0.1969\nM2\n";
    let here = with_part(text);
    let more = ["--tolerance-um", "0.3"];
    let written = compensated(here.path(), &[&more[..], &["--arcs", "lines"]].concat());
    let (code, found, said) = verified(here.path(), "out.ngc", &more);
    assert!(matches!(code, 0 | 4), "{said}");
    let claimed = number(&written["summary"], "max_position_error_after_mm");
    let after = number(&found, "max_position_error_mm");
    // What is along a step is not in the distance from it.
    assert!(
        after > 0.5 * claimed && after < 1.01 * claimed,
        "{after} {claimed}"
    );
}

#[test]
fn a_peck_that_is_left_short_is_all_that_is_wrong() {
    let here = compensated_cuts(HOLE);
    // The first peck ends where the load has come: its second block, down to 0.85 mm, is left out.
    let text = std::fs::read_to_string(here.path().join("out.ngc")).unwrap();
    let short = line_of(&text, |line| {
        line.starts_with("G1") && line.contains("Z-0.8")
    });
    let depth = |line: usize| {
        let block = text.lines().nth(line - 1).unwrap();
        let z = block.split(' ').find_map(|word| word.strip_prefix('Z'));
        z.unwrap().parse::<f64>().unwrap()
    };
    let (code, found, said) = changed(here.path(), |text| without_line(text, short));
    assert_eq!(code, 3, "{said}");
    assert_eq!(uncut(&found).as_array().map(Vec::len), Some(1), "{said}");
    assert_eq!(uncut(&found)[0]["lines"], json!([4, 4]), "{said}");
    let left = number(&uncut(&found)[0], "length_mm");
    assert!(
        (left - (depth(short - 1) - depth(short))).abs() < 1e-5,
        "{said}"
    );
    assert_eq!(found["matched"]["rapids"], json!([]), "{said}");
    assert_eq!(found["missed"], Value::Null, "{said}");
}

/// What is said of `HOLE` behind `SLOT` with its ground lifted, against a tolerance.
fn too_shallow(here: &Path, by_mm: f64, tolerance_um: &str) -> (i32, Value, String) {
    let text = std::fs::read_to_string(here.join("out.ngc")).unwrap();
    std::fs::write(here.join("other.ngc"), lifted(&text, ground(&text), by_mm)).unwrap();
    verified(here, "other.ngc", &["--tolerance-um", tolerance_um])
}

#[test]
fn a_hole_that_is_too_shallow_is_off_by_as_much() {
    let here = compensated_cuts(&format!("{SLOT}{HOLE}"));
    for by_mm in [0.004, 0.021, 0.048] {
        for (tolerance_um, code) in [(1e3 * by_mm - 1.0, 3), (1e3 * by_mm + 1.0, 4)] {
            let (found_code, found, said) =
                too_shallow(here.path(), by_mm, &tolerance_um.to_string());
            assert_eq!(found_code, code, "{by_mm} {tolerance_um}: {said}");
            let off = number(&found, "max_position_error_mm");
            assert!((off - by_mm).abs() < 6e-4, "{off} {by_mm}");
        }
    }
    // What is missed by more is not cut.
    let (code, found, said) = too_shallow(here.path(), 0.06, "200");
    assert_eq!(code, 3, "{said}");
    let left = number(&uncut(&found)[0], "length_mm");
    assert!((left - 0.06).abs() < 1e-3, "{left} {said}");
}

#[test]
fn a_slot_that_ends_too_early_is_off_by_as_much() {
    let here = compensated_cuts(SLOT);
    let (code, found, said) = changed(here.path(), |text| {
        let last = ground(text);
        let shorter = |word: &str| match word.strip_prefix('X') {
            Some(x) => format!("X{:.4}", x.parse::<f64>().unwrap() - 0.03),
            None => word.to_owned(),
        };
        let lines = text.lines().enumerate();
        let lines = lines.map(|(index, block)| match index + 1 == last {
            true => block.split(' ').map(shorter).collect::<Vec<_>>().join(" "),
            false => block.to_owned(),
        });
        lines.map(|block| block + "\n").collect()
    });
    assert_eq!(code, 3, "{said}");
    assert_eq!(found["missed"]["line"], 5, "{said}");
    let off = number(&found, "max_position_error_mm");
    assert!((off - 0.03).abs() < 1e-3, "{off}");
}

/// A block of two thousandths of a millimetre from a corner on, as writers leave them, ends where it ends: it was taken for the corner,
/// and the tool said to be off by its length.
#[test]
fn a_short_block_from_a_corner_on_ends_where_it_ends() {
    const CONTOUR: &str = "G0 X9.5 Y-8.6 Z10\nG0 Z1\nG1 Z-1 F900\nG1 X24.7 Y-8.2\nG1 X25.1 Y6.4\nG1 X12.3 Y7.2\nG0 Z10\n";
    let here = compensated_cuts(CONTOUR);
    let (code, found, said) = verified(here.path(), "out.ngc", &[]);
    assert!(matches!(code, 0 | 4), "{said}");
    let whole = number(&found, "max_position_error_mm");
    let text = std::fs::read_to_string(here.path().join("out.ngc")).unwrap();
    let mut at = [0.0; 3];
    let (mut blocks, mut added) = (String::new(), 0);
    for block in text.lines() {
        let before = at;
        for word in block.split(' ') {
            let axis = word.chars().next().and_then(|axis| "XYZ".find(axis));
            if let (Some(axis), Some(Ok(value))) = (axis, word.get(1..).map(str::parse)) {
                at[axis] = value;
            }
        }
        let way = [0, 1, 2].map(|axis| at[axis] - before[axis]);
        let length = way.iter().map(|w: &f64| w * w).sum::<f64>().sqrt();
        if block.starts_with("G1") && length > 5.0 {
            let [x, y, z] = [0, 1, 2].map(|axis| before[axis] + way[axis] * 0.0018 / length);
            blocks += &format!("G1 X{x:.5} Y{y:.5} Z{z:.5}\n");
            added += 1;
        }
        blocks += &format!("{block}\n");
    }
    assert!(added >= 3, "{added}: {text}");
    std::fs::write(here.path().join("other.ngc"), blocks).unwrap();
    let (code, found, said) = verified(here.path(), "other.ngc", &[]);
    assert!(matches!(code, 0 | 4), "{said}");
    let off = number(&found, "max_position_error_mm");
    assert!(off <= whole + 2e-4, "{off} {whole}");
}
