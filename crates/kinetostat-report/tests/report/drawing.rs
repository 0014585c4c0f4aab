//! Drawings of every preset under a load, as a reader of the SVG file sees them: labels can be read,
//! and the arrow of the force points where the force points.

use crate::common::letters::bold_width;

use kinetostat::{Twist, Wrench, spatial::moved};
use kinetostat_model::{Model, preset_names};
use kinetostat_report::{Drawing, Magnified, Moved, Placed, View};
use nalgebra::{Vector2, Vector3, Vector6};
use roxmltree::{Document, Node};

#[derive(Debug)]
struct Area {
    what: String,
    low: Vector2<f64>,
    high: Vector2<f64>,
}

impl Area {
    fn overlaps(&self, other: &Self) -> bool {
        let (a, b) = (self.low.sup(&other.low), self.high.inf(&other.high));
        a.x < b.x && a.y < b.y
    }
}

fn attribute(node: &Node<'_, '_>, name: &str) -> f64 {
    let text = node.attribute(name).expect(name);
    text.parse()
        .unwrap_or_else(|e| panic!("{name}={text}: {e}"))
}

/// Where the letters of a text are, without the empty space above and below them.
fn area(text: &Node<'_, '_>) -> Area {
    let words = text.text().unwrap_or_default();
    let size = match text.attribute("class") {
        Some("letter") => 11.5,
        Some("title") => 13.5,
        _ => 12.5,
    };
    // The regular type of that family is narrower by a tenth or more.
    let bold = !matches!(text.attribute("class"), Some("name" | "tick"));
    let width = bold_width(words, size) * if bold { 1.0 } else { 0.9 };
    let left = attribute(text, "x")
        - match text.attribute("text-anchor") {
            None => 0.0,
            Some("middle") => 0.5 * width,
            Some(_) => width,
        };
    let base = attribute(text, "y");
    Area {
        what: words.to_owned(),
        low: Vector2::new(left, base - 0.73 * size),
        high: Vector2::new(left + width, base + 0.2 * size),
    }
}

/// All numbers of path data, in order.
fn numbers(data: &str) -> Vec<f64> {
    let text = data.replace(|c: char| c.is_ascii_alphabetic(), " ");
    let words = text.split_whitespace();
    words.map(|w| w.parse().expect("a number")).collect()
}

/// Path data of everything of a class.
fn paths<'a>(svg: &'a Document<'_>, class: &str) -> Vec<&'a str> {
    svg.descendants()
        .filter(|n| n.attribute("class") == Some(class))
        .filter_map(|n| n.attribute("d"))
        .collect()
}

/// Ends of the first straight line of path data.
fn line(data: &str) -> [Vector2<f64>; 2] {
    let n = numbers(data);
    assert_eq!(n.len(), 4, "a line: {data}");
    [Vector2::new(n[0], n[1]), Vector2::new(n[2], n[3])]
}

/// How the drawing sees a direction of the tool's frame, from the axes that it shows.
fn seen_by_axes(svg: &Document<'_>, in_tool: &Vector3<f64>) -> Vector2<f64> {
    ["ax", "ay", "az"]
        .into_iter()
        .zip(in_tool.iter())
        .map(|(class, share)| {
            // The tool's axes come after those of the base.
            let [from, to] = line(paths(svg, class).last().expect("an axis"));
            (to - from) * *share
        })
        .sum()
}

fn check_labels(name: &str, svg: &Document<'_>, wanted: &[&str]) {
    let root = svg.root_element();
    let room = Area {
        what: "view box".to_owned(),
        low: Vector2::zeros(),
        high: Vector2::new(attribute(&root, "width"), attribute(&root, "height")),
    };
    let texts: Vec<Area> = svg
        .descendants()
        .filter(|n| n.has_tag_name("text"))
        .map(|n| area(&n))
        .collect();
    for (i, text) in texts.iter().enumerate() {
        let inside = (text.low - room.low).min() >= 0.0 && (room.high - text.high).min() >= 0.0;
        assert!(inside, "{name}: {text:?} in {room:?}");
        for other in &texts[..i] {
            assert!(!text.overlaps(other), "{name}: {text:?} on {other:?}");
        }
    }
    for want in wanted {
        let found = texts
            .iter()
            .any(|t| t.what.replace('\u{202f}', " ").starts_with(want));
        assert!(found, "{name}: no '{want}' in {texts:?}");
    }
    // Symbols of joints and drives are round or straight: each corner and, of circles, the middle.
    let joints = paths(svg, "joint").into_iter().map(|data| {
        let n = numbers(data);
        Vector2::new(n[0] + n[2], n[1])
    });
    let corners = ["drive", "drive face", "slide", "slide face"];
    let corners = corners
        .iter()
        .flat_map(|class| paths(svg, class))
        .flat_map(|data| {
            let n = numbers(data);
            n.chunks(2)
                .map(|p| Vector2::new(p[0], p[1]))
                .collect::<Vec<_>>()
        });
    let frame = texts.iter().filter(|t| t.what != "passive joint");
    let frame: Vec<&Area> = frame.collect();
    for at in joints.chain(corners) {
        for text in &frame {
            let inside = (at - text.low).min() > 0.5 && (text.high - at).min() > 0.5;
            assert!(!inside, "{name}: {text:?} on a symbol at {at:?}");
        }
    }
}

/// The arrow lies on the drawing and points along what is seen of the force.
fn check_arrow(name: &str, svg: &Document<'_>, class: &str, seen: &Vector2<f64>) {
    let root = svg.root_element();
    let size = Vector2::new(attribute(&root, "width"), attribute(&root, "height"));
    let ring = paths(svg, &format!("{class} ring"));
    let all = [
        paths(svg, class),
        paths(svg, &format!("{class} head")),
        ring.clone(),
    ]
    .concat();
    assert!(!all.is_empty(), "{name}: no arrow of the {class}");
    for data in all.iter().filter(|d| !d.contains('a')) {
        for p in numbers(data).chunks(2).map(|p| Vector2::new(p[0], p[1])) {
            assert!(
                p.min() > 0.0 && (size - p).min() > 0.0,
                "{name}: {class} at {p:?}"
            );
        }
    }
    if !ring.is_empty() {
        assert!(seen.norm() < 0.2 * 44.0, "{name}: a ring for {seen:?}");
        return;
    }
    let [tail, neck] = line(paths(svg, class)[0]);
    let head = numbers(paths(svg, &format!("{class} head"))[0]);
    let tip = Vector2::new(head[0], head[1]);
    let arrow = tip - tail;
    assert!(
        arrow.norm() >= 39.0,
        "{name}: {class} {} pixels long",
        arrow.norm()
    );
    assert!(
        (neck - tail).norm() >= 25.0,
        "{name}: the {class} is all head"
    );
    let sine = arrow.normalize().perp(&seen.normalize());
    // Axes are drawn to a tenth of a pixel.
    let bound = 0.01 + 0.15 / seen.norm();
    assert!(
        arrow.dot(seen) > 0.0 && sine.abs() < bound,
        "{name}: {arrow:?} for {seen:?}"
    );
}

/// Fails unless every view of every preset shows names, force and moment.
#[test]
fn labels_and_arrows_of_every_preset_can_be_read() {
    let force = Vector3::new(300.0, -450.0, -1000.0);
    let moment = Vector3::new(-20.0, 35.0, 10.0);
    let mut drawn = 0;
    for preset in preset_names() {
        let model = Model::preset(preset.name).expect("a preset");
        let m = &model.mechanism;
        let home = m.platforms()[m.tool()].home;
        let posture = m.posture(&home).expect("home");
        let twist = Twist(Vector6::new(1e-5, -2e-5, -3e-5, 0.0, 0.0, 0.0));
        let beside = m.posture(&moved(&home, &twist)).ok();
        for view in [None, Some(View::Front), Some(View::Side), Some(View::Top)] {
            for (load, wanted) in [
                (
                    Wrench::new(force, moment),
                    &["force 1 137 N", "moment 41.53 N m"][..],
                ),
                (
                    Wrench::new(Vector3::new(0.0, 0.0, -500.0), Vector3::zeros()),
                    &["force 500 N"],
                ),
            ] {
                let mut drawing = Drawing::of(m, Placed::at(&posture));
                drawing.view = view;
                drawing.applied = Some(load);
                drawing.moved = beside.as_ref().map(|there| Moved {
                    from: Placed::at(&posture),
                    to: Placed::at(there),
                    magnified: Magnified::Round,
                    name: "deflected".to_owned(),
                });
                let (svg, _) = drawing.svg();
                let svg = Document::parse(&svg).expect("an SVG file");
                let name = format!("{} {view:?} {load:?}", preset.name);
                check_labels(&name, &svg, wanted);
                let tool = posture.platforms()[m.tool()].rotation;
                for (class, vector) in [("force", load.force()), ("moment", load.moment())] {
                    if vector.norm() > 0.0 {
                        let unit = vector.normalize();
                        let seen = seen_by_axes(&svg, &(tool.inverse() * unit));
                        check_arrow(&name, &svg, class, &seen);
                        let known = match view {
                            None | Some(View::Iso) => continue,
                            Some(View::Front) => Vector2::new(unit.x, -unit.z),
                            Some(View::Side) => Vector2::new(unit.y, -unit.z),
                            Some(View::Top) => Vector2::new(unit.x, -unit.y),
                        };
                        check_arrow(&name, &svg, class, &(44.0 * known));
                    }
                }
                drawn += 1;
            }
        }
    }
    assert!(drawn > 200, "{drawn} drawings");
}

/// Without a load there is no arrow.
#[test]
fn no_load_has_no_arrow() {
    let model = Model::preset("delta").expect("a preset");
    let m = &model.mechanism;
    let posture = m.posture(&m.platforms()[m.tool()].home).expect("home");
    let mut drawing = Drawing::of(m, Placed::at(&posture));
    drawing.applied = Some(Wrench::zero());
    let (svg, _) = drawing.svg();
    let svg = Document::parse(&svg).expect("an SVG file");
    assert!(paths(&svg, "force").is_empty() && paths(&svg, "moment").is_empty());
}
