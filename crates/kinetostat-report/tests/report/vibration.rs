//! Pictures of lobes and receptances.

use kinetostat_chatter::{
    Crossing, Instability, LobeDiagram, LobePoint, SpeedStability, ZerothOrderLimit,
};
use kinetostat_report::{DrawnMotion, ReceptanceCurve, lobes_svg, receptance_svg};
use nalgebra::Complex;

fn crossing(depth: f64, unstable_above: bool, kind: Instability) -> Crossing {
    Crossing {
        depth,
        unstable_above,
        kind,
        frequency_hz: 50.0,
        multiplier: (-1.0, 0.0),
        resolved: 0.0,
    }
}

fn point(speed_rpm: f64, crossings: Vec<Crossing>) -> LobePoint {
    LobePoint {
        exact: SpeedStability {
            speed_rpm,
            up_to: 0.02,
            crossings,
            modes_up_to_hz: 100.0,
            left_out: None,
        },
        zeroth_order: Some(ZerothOrderLimit {
            depth: 2e-3,
            frequency_hz: 51.0,
        }),
    }
}

#[test]
fn lobes_show_flip_hopf_islands_and_the_zeroth_order_under_its_name() {
    use Instability::{Flip, Hopf};
    let diagram = LobeDiagram {
        without_answer: Vec::new(),
        up_to: 0.02,
        teeth: 2,
        points: vec![
            point(5000.0, vec![crossing(1e-3, true, Hopf)]),
            point(
                5100.0,
                vec![
                    crossing(9e-4, true, Flip),
                    crossing(2e-3, false, Flip),
                    crossing(4e-3, true, Hopf),
                ],
            ),
            point(
                5200.0,
                vec![
                    crossing(8e-4, true, Flip),
                    crossing(3e-3, false, Flip),
                    crossing(5e-3, true, Hopf),
                ],
            ),
            point(5300.0, vec![]),
        ],
    };
    let svg = lobes_svg(&diagram, "an <arm>");
    let _ = roxmltree::Document::parse(&svg).unwrap();
    assert!(svg.contains("zeroth order (no bound)") && svg.contains("half the tooth frequency"));
    assert!(svg.contains("depth of cut, mm") && svg.contains("spindle speed, rpm"));
    assert!(!svg.contains("NaN") && !svg.contains("<arm>"));
    // Between the two speeds with an island two areas, beside them one to each middle, and none where all is stable.
    let area = svg.split("class=\"unstable\" d=\"").nth(1).unwrap();
    let area = area.split('"').next().unwrap();
    assert_eq!(area.matches('z').count(), 1 + 2 + 2 + 2, "{area}");
    // The last speed has no limit: a line along the largest depth says so.
    assert!(svg.contains("stable up to 20 mm, the largest depth looked at (--depth-mm)"));
    // Where each speed has a limit, the picture ends a little above the highest change of stability.
    let limited = LobeDiagram {
        points: diagram.points[..3].to_vec(),
        ..diagram.clone()
    };
    let svg = lobes_svg(&limited, "limited");
    assert!(svg.contains(">5<") && !svg.contains(">10<") && !svg.contains(">20<"));
    // Nothing at all is no fault.
    let nothing = LobeDiagram {
        points: vec![],
        ..diagram
    };
    assert!(lobes_svg(&nothing, "nothing").contains("no points to show"));
}

#[test]
fn receptances_have_magnitude_and_phase() {
    let curve = |dashed: bool| ReceptanceCurve {
        name: if dashed {
            "measured".into()
        } else {
            "model".into()
        },
        dashed,
        frequencies_hz: vec![0.0, 10.0, 20.0, 40.0],
        receptance: vec![
            Complex::new(0.0, 0.0),
            Complex::new(1e-6, 0.0),
            Complex::new(0.0, -1e-5),
            Complex::new(-1e-7, -1e-9),
        ],
    };
    let svg = receptance_svg(
        &[curve(false), curve(true)],
        DrawnMotion::Receptance,
        "tool",
    );
    let _ = roxmltree::Document::parse(&svg).unwrap();
    // Both are the same: only one of them is seen.
    assert_eq!(svg.matches(">measured (under model)<").count(), 1);
    assert!(svg.contains("phase, deg") && svg.contains("\u{b5}m/N") && !svg.contains("NaN"));
}
