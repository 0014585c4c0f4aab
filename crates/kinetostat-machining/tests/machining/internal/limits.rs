//! Limits by their names, their ranges, and what is said beyond them.

use kinetostat_machining::internal::figure_beyond;
use kinetostat_machining::{Beyond, Limits, number};

#[test]
fn each_limit_is_read_and_moved_by_its_name() {
    for (i, limit) in Limits::ALL.into_iter().enumerate() {
        let mut limits = Limits::default();
        let value = 17.0 + i as f64;
        limits.set(Limits::named(limit.name).expect("its own name"), value);
        assert_eq!(limits.get(limit), value);
        for other in Limits::ALL.into_iter().filter(|o| *o != limit) {
            assert_eq!(limits.get(other), Limits::default().get(other), "{other:?}");
        }
    }
    assert!(Limits::named("correction").is_none());
}

#[test]
fn every_default_is_in_its_range_and_no_size_is_negative() {
    for limit in Limits::ALL {
        let value = Limits::default().get(limit);
        assert!(
            limit.takes(value),
            "{limit:?}: {}",
            limit.range_description()
        );
        let is_tool = limit.name.ends_with("tool_mm");
        assert_eq!(limit.takes(-value), is_tool, "{limit:?}");
        // A base or a rounding may be as near to zero as one likes.
        let is_from_zero = is_tool || limit.name.ends_with("base_mm") || limit.name == "zone_mm";
        for none in [0.0, f64::MIN_POSITIVE] {
            assert_eq!(limit.takes(none), is_from_zero, "{limit:?} {none}");
        }
        for none in [f64::NAN, f64::INFINITY, -f64::INFINITY] {
            assert!(!limit.takes(none), "{limit:?} {none}");
        }
    }
    let named = |name: &str| Limits::named(name).expect("known").range_description();
    assert_eq!(named("tilt_deg"), "0.000001 to 180 deg can be allowed");
    assert_eq!(named("share_of_rating"), "0.001 to 1000 can be allowed");
}

/// The screen and the report round a largest value up; so does the refusal.
#[test]
fn a_figure_that_was_found_is_rounded_as_elsewhere() {
    let said = |name: &str, found: f64, allowed: f64| {
        let limit = Limits::named(name).expect("known");
        figure_beyond(&limit, found, allowed)
    };
    for rate in [560.0001, 560.4, 560.9999, 12.34, 0.31234] {
        let largest = number::largest(rate, "");
        let plain = number::without_zeros(&largest);
        assert_eq!(said("blocks_per_second", rate, 0.3), plain);
    }
    assert_eq!(said("force_n", 5001.0, 5000.0), "5001");
    assert_eq!(said("shortest_tool_mm", 0.18, 1.0), "0.18");
}

#[test]
fn the_advice_would_allow_what_was_found() {
    for (limit, found) in [
        ("correction_mm", 144.0),
        ("share_of_rating", 1.003),
        ("shortest_tool_mm", -180.0),
        ("shortest_tool_mm", 0.18),
        ("force_n", 215_000.0),
    ] {
        let limit = Limits::named(limit).expect("known");
        let beyond = Beyond {
            limit,
            found,
            allowed: Limits::default().get(limit),
            line: Some(3),
            place: String::new(),
        };
        let text = beyond.to_string();
        let value: f64 = text
            .rsplit(' ')
            .next()
            .and_then(|v| v.parse().ok())
            .expect("a number at the end");
        match limit.name {
            "shortest_tool_mm" => assert!(value <= found, "{text}"),
            _ => assert!(value >= found && value < 1.2 * found, "{text}"),
        }
        assert!(text.contains(&format!("--limit {}=", limit.name)), "{text}");
    }
}
