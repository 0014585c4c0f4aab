//! Corners, arcs, entries and exits by closed forms.

use std::f64::consts::{FRAC_PI_2, PI};

use super::{Wanted, assert_made};

/// A tool of radius 2 to the left of the x axis, and one more move from the origin.
fn after_the_axis(last: &str) -> String {
    format!("G21 G90 G17 F100\nG0 X-30 Y-10 Z0\nG41.1 D4\nG1 X-20 Y0\nX0\n{last}\nG40\nM2\n")
}

/// How the program above goes on from beside (-20, 0): the entry comes from the left below and ends square to itself.
fn entry() -> [Wanted; 2] {
    let r = 2.0_f64;
    let root = 0.5_f64.sqrt();
    let turn = -PI / 4.0;
    [
        (-20.0 - r * root, r * root, None),
        (-20.0, r, Some(([-20.0, 0.0], turn))),
    ]
}

#[test]
fn round_an_outside_corner_the_tool_rolls_about_the_corner() {
    for degrees in [4.0, 30.0, 90.0, 135.0, 178.0, 180.0, 182.0_f64] {
        // To the right, away from a tool on the left.
        let angle = -degrees.to_radians();
        let (sine, cosine) = angle.sin_cos();
        let text = after_the_axis(&format!("X{:.15} Y{:.15}", 10.0 * cosine, 10.0 * sine));
        let [one, two] = entry();
        let beside = [-2.0 * sine, 2.0 * cosine];
        let expected = [
            one,
            two,
            (0.0, 2.0, None),
            (beside[0], beside[1], Some(([0.0; 2], angle))),
            (10.0 * cosine + beside[0], 10.0 * sine + beside[1], None),
        ];
        assert_made(&text, 4, &expected);
    }
}

#[test]
fn in_an_inside_corner_the_tool_stops_where_it_touches_both_lines() {
    for degrees in [4.0, 30.0, 90.0, 120.0, 150.0_f64] {
        let angle = degrees.to_radians();
        let (sine, cosine) = angle.sin_cos();
        let text = after_the_axis(&format!("X{:.15} Y{:.15}", 15.0 * cosine, 15.0 * sine));
        let back = 2.0 * (0.5 * angle).tan();
        let [one, two] = entry();
        let expected = [
            one,
            two,
            (-back, 2.0, None),
            (15.0 * cosine - 2.0 * sine, 15.0 * sine + 2.0 * cosine, None),
        ];
        assert_made(&text, 4, &expected);
    }
}

#[test]
fn straight_on_there_is_no_corner() {
    let [one, two] = entry();
    let expected = [one, two, (0.0, 2.0, None), (15.0, 2.0, None)];
    assert_made(&after_the_axis("X15"), 4, &expected);
}

#[test]
fn the_right_side_is_the_mirror_of_the_left() {
    let text = "G21 G90 G17 F100\nG0 X0 Y20 Z0\nG42.1 D4\nG1 X0 Y0\nX10\nY-10\nX20\nG40\nM2\n";
    // Round the first corner, round the second, into the third.
    assert_made(
        text,
        4,
        &[
            (-2.0, 0.0, None),
            (0.0, -2.0, Some(([0.0; 2], FRAC_PI_2))),
            (8.0, -2.0, None),
            (8.0, -10.0, None),
            (10.0, -12.0, Some(([10.0, -10.0], FRAC_PI_2))),
            (20.0, -12.0, None),
        ],
    );
}

#[test]
fn beside_an_arc_the_tool_runs_about_its_centre() {
    let [one, two] = entry();
    // Tangent to the axis: to the right outside the arc, to the left inside.
    let outside = [
        one,
        two,
        (0.0, 2.0, None),
        (12.0, -10.0, Some(([0.0, -10.0], -FRAC_PI_2))),
    ];
    assert_made(&after_the_axis("G2 X10 Y-10 I0 J-10"), 4, &outside);
    let inside = [
        one,
        two,
        (0.0, 2.0, None),
        (8.0, 10.0, Some(([0.0, 10.0], FRAC_PI_2))),
    ];
    assert_made(&after_the_axis("G3 X10 Y10 I0 J10"), 4, &inside);
    assert_made(&after_the_axis("G3 X10 Y10 R10"), 4, &inside);
}

#[test]
fn a_line_meets_an_arc_in_an_inside_corner() {
    let [one, two] = entry();
    // The arc starts upwards; the tool is inside it (G3, centre on the left) or outside.
    let x = -10.0 + (8.0_f64 * 8.0 - 4.0).sqrt();
    let turn = FRAC_PI_2 - (2.0 / 8.0_f64).asin();
    let inside = [
        one,
        two,
        (x, 2.0, None),
        (-10.0, 8.0, Some(([-10.0, 0.0], turn))),
    ];
    assert_made(&after_the_axis("G3 X-10 Y10 I-10 J0"), 4, &inside);
    let x = 10.0 - (12.0_f64 * 12.0 - 4.0).sqrt();
    let turn = -FRAC_PI_2 + (2.0 / 12.0_f64).asin();
    let outside = [
        one,
        two,
        (x, 2.0, None),
        (10.0, 12.0, Some(([10.0, 0.0], turn))),
    ];
    assert_made(&after_the_axis("G2 X10 Y10 I10 J0"), 4, &outside);
}

#[test]
fn an_arc_meets_a_line_in_an_inside_corner() {
    // Down a quarter circle to the origin, then along the x axis; the tool is inside the arc, then outside.
    let x = 10.0 - (8.0_f64 * 8.0 - 4.0).sqrt();
    let text = "G21 G90 G17 F100\nG0 X30 Y10 Z0\nG41.1 D4\nG1 X10 Y10\nG3 X0 Y0 I0 J-10\nG1 X30\nG40\nM2\n";
    // The line after the arc goes up the x axis: the arc arrives downwards, centre (10, 0).
    let down =
        "G21 G90 G17 F100\nG0 X30 Y10 Z0\nG41.1 D4\nG1 X10 Y10\nG3 X0 Y0 I0 J-10\nG1 X8\nG40\nM2\n";
    let turn = FRAC_PI_2 - (2.0 / 8.0_f64).asin();
    for (text, end) in [(text, 30.0), (down, 8.0)] {
        let expected = [
            (10.0, 8.0, None),
            (x, 2.0, Some(([10.0, 0.0], turn))),
            (end, 2.0, None),
        ];
        assert_made(text, 4, &expected);
    }
    let x = -10.0 + (12.0_f64 * 12.0 - 4.0).sqrt();
    let text = "G21 G90 G17 F100\nG0 X-30 Y10 Z0\nG41.1 D4\nG1 X-10 Y10\nG2 X0 Y0 I0 J-10\nG1 X30\nG40\nM2\n";
    let turn = -FRAC_PI_2 + (2.0 / 12.0_f64).asin();
    let expected = [
        (-10.0, 12.0, None),
        (x, 2.0, Some(([-10.0, 0.0], turn))),
        (30.0, 2.0, None),
    ];
    assert_made(text, 4, &expected);
}

#[test]
fn two_arcs_meet_where_their_circles_do() {
    // Two half circles side by side, the tool above: it does not reach the foot between them.
    let text =
        "G21 G90 G17 F100\nG0 X-20 Y-20 Z0\nG41.1 D4\nG1 X-20 Y0\nG2 X0 I10 J0\nX20 I10\nG40\nM2\n";
    let y = (12.0_f64 * 12.0 - 100.0).sqrt();
    let turn = -(PI - (y / 12.0).asin());
    assert_made(
        text,
        4,
        &[
            (-22.0, 0.0, None),
            (0.0, y, Some(([-10.0, 0.0], turn))),
            (22.0, 0.0, Some(([10.0, 0.0], turn))),
        ],
    );
    // The same from inside: two bowls with a ridge between them, which the tool rounds.
    let text =
        "G21 G90 G17 F100\nG0 X-20 Y20 Z0\nG41.1 D4\nG1 X-20 Y0\nG3 X0 I10 J0\nX20 I10\nG40\nM2\n";
    assert_made(
        text,
        4,
        &[
            (-18.0, 0.0, None),
            (-2.0, 0.0, Some(([-10.0, 0.0], PI))),
            (2.0, 0.0, Some(([0.0; 2], -PI))),
            (18.0, 0.0, Some(([10.0, 0.0], PI))),
        ],
    );
}

#[test]
fn a_full_circle_stays_one() {
    let text =
        "G21 G90 G17 F100\nG0 X10 Y-20 Z0\nG41.1 D4\nG1 X10 Y0\nG3 X10 Y0 I-10 J0\nG40\nM2\n";
    let expected = [(8.0, 0.0, None), (8.0, 0.0, Some(([0.0; 2], 2.0 * PI)))];
    assert_made(text, 4, &expected);
}

#[test]
fn an_entry_by_an_arc_ends_tangent_to_it() {
    let text = "G21 G90 G17 F100\nG0 X0 Y0 Z0\nG41.1 D2\nG3 X10 Y10 I0 J10\nG1 Y20\nG40\nM2\n";
    // The centre is on y = 10, as far from (9, 10) as from the origin.
    let radius = 181.0 / 18.0;
    let centre = [9.0 - radius, 10.0];
    let turn = 10.0_f64.atan2(-centre[0]);
    let expected = [(9.0, 10.0, Some((centre, turn))), (9.0, 20.0, None)];
    assert_made(text, 4, &expected);
    // Outside: the tool is on the other side of the end.
    let text = text.replace("G41", "G42");
    let radius = 221.0 / 22.0;
    let centre = [11.0 - radius, 10.0];
    let turn = 10.0_f64.atan2(-centre[0]);
    let expected = [(11.0, 10.0, Some((centre, turn))), (11.0, 20.0, None)];
    assert_made(&text, 4, &expected);
}

#[test]
fn behind_g40_the_next_move_starts_beside_the_contour_and_ends_where_it_says() {
    let text = "G21 G90 G17 F100\nG0 X0 Y-20 Z0\nG41.1 D4\nG1 X0 Y0\nY10\nG40\nG0 Z5\nX7\nM2\n";
    // A move in depth alone goes back to the programmed place, as LinuxCNC does it.
    assert_made(
        text,
        4,
        &[
            (-2.0, 0.0, None),
            (-2.0, 10.0, None),
            (0.0, 10.0, None),
            (7.0, 10.0, None),
        ],
    );
    let in_one_block =
        "G21 G90 G17 F100\nG0 X0 Y-20 Z0\nG41.1 D4\nG1 X0 Y0\nY10\nG40 G91 G1 X5\nM2\n";
    assert_made(in_one_block, 6, &[(5.0, 10.0, None)]);
}

#[test]
fn no_arc_is_rapid() {
    let text = "G21 G90 G17 F100\nG0 X0 Y-20 Z0\nG41.1 D4\nG0 X0 Y0\nX10\nM2\n";
    let expected = [(-2.0, 0.0, None), (0.0, 2.0, None), (10.0, 2.0, None)];
    assert_made(text, 4, &expected);
}

#[test]
fn moves_in_depth_stand_in_the_corner() {
    let text =
        "G21 G90 G17 F100\nG0 X0 Y-20 Z5\nG41.1 D4\nG1 X0 Y0\nY20\nG0 Z9\nG1 Z5\nX-20\nG40\nM2\n";
    let expected = [
        (-2.0, 0.0, None),
        (-2.0, 18.0, None),
        (-2.0, 18.0, None),
        (-2.0, 18.0, None),
        (-20.0, 18.0, None),
    ];
    assert_made(text, 4, &expected);
}
