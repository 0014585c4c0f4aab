//! The page holds what it must, whatever the data.

use crate::common::*;
use kinetostat_machining::{LargestChange, LoadBegins, LoadRamp, PointResult, RunResult};
use kinetostat_report::ReportError;

fn fixtures() -> Vec<(&'static str, RunResult)> {
    let mut one_point = circle_groove();
    one_point.points.truncate(1);
    one_point.points[0].kind = kinetostat_machining::PointKind::Feed;
    one_point.worst_points = one_point.points.clone();
    let mut not_converged = circle_groove();
    not_converged.summary.converged = false;
    let mut elongated = pocket_on_serial_robot(1500);
    for point in elongated
        .points
        .iter_mut()
        .chain(&mut elongated.worst_points)
    {
        point.position_mm[1] *= 0.4;
        point.position_mm[0] *= 4.0;
    }
    let blank_points = {
        let mut result = RunResult::default();
        result.points = vec![PointResult::default(); 3];
        result
    };
    let mut many = pocket_on_serial_robot(300);
    let repeated = many.run_inputs.actuators.clone();
    many.run_inputs
        .actuators
        .extend(repeated.iter().cloned().cycle().take(20));
    vec![
        ("circle", circle_groove()),
        ("pocket", pocket_on_serial_robot(4000)),
        ("elongated", elongated),
        ("analysis", analysis()),
        ("unstable", unstable()),
        ("not-converged", not_converged),
        ("one-point", one_point),
        ("empty", RunResult::default()),
        ("blank-points", blank_points),
        ("many-actuators", many),
        ("hostile-numbers", hostile_numbers()),
        ("hostile-text", hostile_text()),
    ]
}

/// Text as a reader sees it, near enough for finding sentences.
fn plain(page: &str) -> String {
    page.replace('\u{202f}', " ")
        .replace("&#x2f;", "/")
        .replace("&#x27;", "'")
}

/// Fails unless every element that is opened is closed, in order.
fn assert_balanced(name: &str, page: &str) {
    let mut open: Vec<&str> = Vec::new();
    let body = page.replace("<!DOCTYPE html>", "");
    for tag in body.split('<').skip(1) {
        let (tag, _) = tag.split_once('>').expect("every tag ends");
        let word = tag
            .trim_end_matches('/')
            .split_whitespace()
            .next()
            .expect("a tag has a name");
        if let Some(closed) = word.strip_prefix('/') {
            assert_eq!(
                open.pop(),
                Some(closed),
                "{name}: </{closed}> closes something else"
            );
        } else if !tag.ends_with('/') && word != "meta" && word != "br" {
            open.push(word);
        }
    }
    assert!(open.is_empty(), "{name}: {open:?} stay open");
}

/// The page of a result that is assessed first, as a run is.
fn html(result: &RunResult) -> Result<String, ReportError> {
    let mut result = result.clone();
    result.assess();
    kinetostat_report::html(&result)
}

/// Set `KINETOSTAT_REPORT_DIR` to keep the pages and look at them.
#[test]
fn every_page_is_sound() {
    let temporary = tempfile::tempdir().unwrap();
    let folder = std::env::var_os("KINETOSTAT_REPORT_DIR")
        .map_or_else(|| temporary.path().to_owned(), Into::into);
    for (name, result) in fixtures() {
        let page = html(&result).unwrap();
        std::fs::write(folder.join(format!("{name}.html")), &page).unwrap();
        assert_eq!(page, html(&result).unwrap(), "{name}: two runs differ");
        let links = page.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
        for word in [
            "http:",
            "https:",
            "//",
            "<script",
            "<img",
            "onerror=\"",
            "javascript:",
            "@import",
            "url(",
        ] {
            assert!(!links.contains(word), "{name} contains {word}");
        }
        for word in ["NaN", "inf ", ">inf", "-inf", "Some(", "\u{202e}", "\u{0}"] {
            assert!(!page.contains(word), "{name} contains {word:?}");
        }
        assert_balanced(name, &page);
        assert!(page.len() < 1_500_000, "{name} has {} bytes", page.len());
        assert!(page.contains("default-src &#39;none&#39;") || page.contains("default-src 'none'"));
    }
}

#[test]
fn the_result_comes_first_and_in_words() {
    let page = plain(&html(&circle_groove()).unwrap());
    let start = page
        .find("class=\"assessment good\"")
        .expect("an assessment");
    assert!(start < page.find("class=\"cards").expect("cards"));
    assert!(
        page.contains("with the compensated program at most 0.528 µm."),
        "the assessment names the error after: {}",
        &page[start..start + 600]
    );
    assert!(page.contains("which a program of positions cannot correct"));
    assert!(plain(&html(&analysis()).unwrap()).contains("This is an analysis only"));
    assert!(plain(&html(&unstable()).unwrap()).contains("class=\"assessment stop\""));
}

#[test]
fn sections_stand_in_order() {
    let page = html(&circle_groove()).unwrap();
    let headings = [
        "How far the tool is off along the path",
        "Where the tool goes",
        "What the actuators carry",
        "How stiff the machine is",
        "The worst places",
        "What was not corrected",
        "<h2>Warnings",
        "What was asked",
    ];
    let places: Vec<usize> = headings
        .iter()
        .map(|heading| page.find(heading).unwrap_or_else(|| panic!("no {heading}")))
        .collect();
    assert!(places.is_sorted(), "{places:?}");
    assert_eq!(page.matches("class=\"plot wide\"").count(), 4);
    assert_eq!(page.matches("class=\"plot narrow\"").count(), 4);
}

#[test]
fn what_users_of_such_tools_ask_for_is_said() {
    let page = plain(&html(&pocket_on_serial_robot(4000)).unwrap());
    for text in [
        "4 000 of 80 532 points shown: the worst of every stretch are among them.",
        "path 0.5 µm, chords of arcs 0.2 µm",
        "40 266 (1 220 345 bytes)",
        "41 377 (1 301 002 bytes)",
        "1 111 were divided, 0 corrected in one piece and 39 155 carried over byte for byte",
        "Most blocks per second",
        "Straight pieces written",
        "N m",
        "Corner steps",
        "Rounding",
    ] {
        assert!(page.contains(text), "the page lacks {text:?}");
    }
    assert!(
        !plain(&html(&circle_groove()).unwrap()).contains("points shown"),
        "nothing is left out there"
    );
}

#[test]
fn how_fast_the_correction_changes_is_said() {
    let mut result = circle_groove();
    let mut change = LargestChange::default();
    (change.value, change.line, change.stated) = (0.4312, 8, Some(0.5));
    result.summary.largest_change_mm_per_mm = Some(change);
    result.summary.load_ramp = Some(LoadRamp {
        begins: LoadBegins::AfterRapid,
        length_mm: 1.25,
    });
    let page = plain(&html(&result).unwrap());
    assert!(page.contains("Change of the correction"));
    assert!(page.contains("at line 8; no line changes faster than the 0.5 mm/mm that are stated"));
    assert!(page.contains("over at most the first 1.25 mm of feed"));
    assert!(!page.contains("Steps where a rapid ends"));
    change.lines_beyond = 3;
    (change.value, result.summary.entry_steps) = (0.83, 2);
    result.summary.largest_change_mm_per_mm = Some(change);
    result.summary.largest_entry_step_mm = 0.21;
    let page = plain(&html(&result).unwrap());
    assert!(page.contains("3 lines change faster than stated (0.5 mm/mm at this one"));
    assert!(page.contains("Steps where a rapid ends") && page.contains("2, longest"));
}

/// Joint values stand between the limits of the model, and a machine without limits, ratings and configuration has no such section.
#[test]
fn joint_values_stand_between_their_limits() {
    const TITLE: &str = "How near the joints are to their limits";
    let mut result = pocket_on_serial_robot(300);
    assert!(!html(&result).unwrap().contains(TITLE));
    let actuators = &mut result.run_inputs.actuators;
    let names: Vec<String> = actuators.iter().map(|a| a.name.clone()).collect();
    for actuator in actuators.iter_mut().skip(1) {
        actuator.limits = Some([-123.0, 45.0]);
    }
    result.joints.ranges = vec![[-30.0, 30.0]; names.len()];
    for (number, point) in result.points.iter_mut().enumerate() {
        let value = 30.0 * (0.02 * number as f64).sin();
        point.actuator_command = vec![value; names.len()];
        point.actuator_command[1] = match number {
            17 => f64::NAN,
            _ => value,
        };
    }
    let page = html(&result).unwrap();
    assert_balanced("limits", &page);
    assert!(page.contains(TITLE) && !page.contains("NaN"));
    for name in &names {
        let title = format!(">{name}: \u{2212}30 to 30");
        assert!(page.contains(&title), "{title}");
    }
    // On the wide sheet and on the narrow one.
    for limit in ["limit \u{2212}123", "limit 45"] {
        let times = page.matches(&format!(">{limit}<")).count();
        assert_eq!(times, 2 * (names.len() - 1), "{limit}");
    }
}

#[test]
fn worst_points_carry_line_numbers() {
    let result = pocket_on_serial_robot(4000);
    let page = plain(&html(&result).unwrap());
    for point in &result.worst_points {
        let digits = point.line.to_string();
        let (thousands, rest) = digits.split_at(digits.len() - 3);
        assert!(
            page.contains(&format!("<td class=\"left total\">{thousands} {rest}<")),
            "line {digits} is missing"
        );
    }
    assert!(page.contains("class=\"mark-name\""));
}

#[test]
fn missing_numbers_are_words() {
    let page = html(&hostile_numbers()).unwrap();
    assert!(page.contains("not available"));
    assert!(page.contains("Points without a number"));
    assert!(
        !html(&circle_groove())
            .unwrap()
            .contains("Points without a number")
    );
}

/// The plot, the card and the result speak of one bound: path, chords and rounding together.
#[test]
fn the_line_of_the_plot_is_the_bound_that_is_compared() {
    let mut result = circle_groove();
    let worst = result.summary.max_position_error_after_mm;
    result.run_inputs.tolerance_mm = 3.0 * worst;
    result.run_inputs.chord_tolerance_mm = 1.5 * worst;
    result.summary.max_rounding_error_mm = 0.5 * worst;
    assert!((result.allowed_mm() / (5.0 * worst) - 1.0).abs() < 1e-12);
    let page = html(&result).expect("a page");
    let reported = |page: &str| page.matches("allowed").count();
    assert!(reported(&plain(&page)) >= 2, "card and plot");
    assert!(page.contains("class=\"assessment good\""), "held");
    result.run_inputs.tolerance_mm = 0.1 * worst;
    result.run_inputs.chord_tolerance_mm = 0.0;
    result.summary.max_rounding_error_mm = 0.0;
    assert_eq!(result.holds_tolerance(), Some(false));
    let page = html(&result).expect("a page");
    assert!(page.contains("class=\"assessment attention\""), "missed");
    assert!(page.contains("The tolerance is missed"), "said first");
    result.summary.max_position_error_after_mm = f64::NAN;
    assert_eq!(
        result.holds_tolerance(),
        Some(false),
        "no number holds nothing"
    );
}

/// A program of a hundred thousand points says no more than its drawings can show.
#[test]
fn the_page_of_a_long_program_is_short() {
    let page = html(&pocket_on_serial_robot(100_000)).unwrap();
    assert!(page.len() < 500_000, "{} bytes", page.len());
}

/// On telephones, in a type that is wider than most.
#[test]
fn no_title_of_a_plot_is_cut() {
    for (name, result) in fixtures() {
        let page = html(&result).unwrap();
        for svg in page.split("<svg ").skip(1) {
            let svg = format!("<svg {}", svg.split_inclusive("</svg>").next().unwrap());
            let svg = roxmltree::Document::parse(&svg).expect("a drawing");
            let size = svg.root_element().attribute("viewBox").unwrap();
            let width: f64 = size.split(' ').nth(2).unwrap().parse().unwrap();
            let titles = svg
                .descendants()
                .filter(|n| n.attribute("class") == Some("title"));
            for title in titles {
                let text = title.text().unwrap_or_default();
                let left: f64 = title.attribute("x").unwrap().parse().unwrap();
                let right = left + crate::common::letters::bold_width(text, 13.5);
                assert!(
                    left >= 0.0 && right <= width,
                    "{name}: {text} to {right} of {width}"
                );
            }
        }
    }
}
