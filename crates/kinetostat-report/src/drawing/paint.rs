//! The scene on paper.

use std::collections::BTreeSet;

use nalgebra::Vector3;

use crate::chart::label::{Beside, Frame, Names, TEXT_SIZE, title_lines};
use crate::drawing::order::{Thing, painting_order, rim};
use crate::drawing::parts::{Bar, BarKind, Blob, BlobKind, Scene};
use crate::drawing::symbol::{self, Point, flat};
use crate::drawing::view::Camera;
use crate::drawing::{Drawing, Magnified, Moved};
use crate::svg::{Anchor, Svg};
use crate::text;

const STYLE: &str = concat!(
    include_str!("../template/palette.css"),
    include_str!("../template/plot.css"),
    include_str!("../template/drawing.css")
);

const WIDTH: f64 = 760.0;
/// Room around the machine, pixels.
const MARGIN: [f64; 2] = [70.0, 44.0];
const TALLEST: f64 = 430.0;
/// Height of scale and legend.
const FOOT: f64 = 54.0;
/// Length of axes, pixels of the machine's diagonal in [`Scene`].
const AXIS: f64 = 44.0;

/// Projection from space to paper.
struct Paper {
    camera: Camera,
    scale: f64,
    shift: [f64; 2],
}

impl Paper {
    fn at(&self, p: &Vector3<f64>) -> Point {
        let q = self.camera.project(p) * self.scale;
        Point::new(q.x + self.shift[0], q.y + self.shift[1], q.z)
    }

    /// A direction of space: as long on paper as it is long there, in pixels.
    fn direction(&self, v: &Vector3<f64>) -> Point {
        self.camera.project(v)
    }
}

/// The motion as it is drawn.
struct Overlay {
    bars: Vec<Bar>,
    plates: Vec<Vec<Vector3<f64>>>,
    tool: Vector3<f64>,
    factor: f64,
}

impl Overlay {
    /// Motions of the bars' ends.
    fn motions(&self, scene: &Scene) -> Vec<Vector3<f64>> {
        let pairs = self.bars.iter().zip(&scene.bars);
        pairs
            .flat_map(|(moved, bar)| [0, 1].map(|k| moved.ends[k] - bar.ends[k]))
            .filter(|w| w.iter().all(|x| x.is_finite()))
            .collect()
    }
}

impl Drawing<'_> {
    /// The drawing as an SVG document with its own style, right on light and on dark pages and on
    /// paper, and the factor by which the motion was drawn larger.
    #[must_use]
    pub fn svg(&self) -> (String, f64) {
        paint(self)
    }
}

fn paint(d: &Drawing<'_>) -> (String, f64) {
    let scene = Scene::of(d.mechanism, &d.placed);
    let overlay = d.moved.as_ref().map(|m| overlay_of(d, m, &scene));
    let factor = overlay.as_ref().map_or(1.0, |o| o.factor);
    let mut svg = Svg::default();
    let set: Vec<Overlay> = d.set.iter().map(|m| overlay_of(d, m, &scene)).collect();
    let shown = || match set.is_empty() {
        true => overlay.as_slice(),
        false => set.as_slice(),
    };
    let mut motions: Vec<Vec<Vector3<f64>>> = shown().iter().map(|o| o.motions(&scene)).collect();
    motions.extend(
        d.applied
            .iter()
            .flat_map(|w| [vec![w.force()], vec![w.moment()]]),
    );
    let camera = Camera::of(d.view, &scene, &motions);
    let axes = axes(&scene);

    // Everything has to fit.
    let mut points: Vec<Point> = Vec::new();
    let mut room = |p: &Vector3<f64>| {
        let p = camera.project(p);
        if p.iter().all(|x| x.is_finite()) {
            points.push(p);
        }
    };
    scene
        .bars
        .iter()
        .flat_map(|b| b.ends)
        .for_each(|p| room(&p));
    scene.blobs.iter().for_each(|b| room(&b.at));
    scene.grounds.iter().for_each(|g| room(&g.at));
    axes.iter().flat_map(|a| &a.ends).for_each(&mut room);
    for o in shown() {
        o.bars.iter().flat_map(|b| b.ends).for_each(|p| room(&p));
        o.bars.iter().for_each(|b| room(&b.middle()));
        room(&o.tool);
    }
    let (low, high) =
        super::scene::corners(points.into_iter()).unwrap_or((Point::zeros(), Point::zeros()));
    let (wide, tall) = ((high.x - low.x).max(1e-12), (high.y - low.y).max(1e-12));
    let scale = ((WIDTH - 2.0 * MARGIN[0]) / wide)
        .min((TALLEST - 2.0 * MARGIN[1]) / tall)
        .min(1.3 / scene.unit.max(1e-15));

    let words = heading(d, &mut Svg::default());
    let height = words + (tall * scale + 2.0 * MARGIN[1]).max(150.0) + FOOT;
    svg.rectangle("card", [0.5, 0.5], [WIDTH - 1.0, height - 1.0], 10.0);
    heading(d, &mut svg);
    let frame = Frame {
        x: 8.0,
        y: words,
        width: WIDTH - 16.0,
        height: height - words - FOOT,
    };
    let paper = Paper {
        camera,
        scale,
        shift: [
            0.5 * WIDTH - 0.5 * (low.x + high.x) * scale,
            frame.y + 0.5 * frame.height - 0.5 * (low.y + high.y) * scale,
        ],
    };
    let mut names = Names::within(frame);

    for ground in &scene.grounds {
        let at = paper.at(&ground.at);
        symbol::ground(&mut svg, flat(&at), &paper.direction(&ground.away));
    }
    machine(&mut svg, &mut names, &scene, &paper);
    if let Some(o) = &overlay {
        motion(&mut svg, &mut names, &scene, o, &paper);
    }
    for axes in &axes {
        axes.draw(&mut svg, &mut names, &paper);
    }
    if let Some(wrench) = &d.applied {
        let tool = flat(&paper.at(&scene.tool.translation.vector));
        symbol::wrench_arrows(&mut svg, &mut names, tool, wrench, |v| paper.direction(v));
    }
    for axes in &axes {
        axes.name(&mut svg, &mut names, &paper);
    }
    for word in &scene.words {
        let beside = Beside::point(flat(&paper.at(&word.at)), word.radius);
        let text = text::shorten(&word.text, 24);
        names.write_as(&mut svg, "mark-name", &beside, &text);
    }
    let left = scale_bar(&mut svg, scale, height);
    let entries = entries(&scene, d, factor);
    legend(&mut svg, &entries, left, height);
    let description = format!("Drawing: {}", d.title);
    (svg.document([WIDTH, height], &description, STYLE), factor)
}

/// Title and note; returns the height that they take.
fn heading(d: &Drawing<'_>, svg: &mut Svg) -> f64 {
    let mut base = 27.0;
    for (k, line) in title_lines(&d.title, WIDTH - 36.0).iter().enumerate() {
        base = 27.0 + 18.0 * k as f64;
        svg.text("title", [18.0, base], Anchor::Start, line);
    }
    let mut line = String::new();
    let mut lines = Vec::new();
    for word in d.note.split_whitespace() {
        let longer = format!("{line}{}{word}", if line.is_empty() { "" } else { " " });
        if 1.1 * text::width(&longer, TEXT_SIZE) > WIDTH - 40.0 && !line.is_empty() {
            lines.push(std::mem::replace(&mut line, word.to_owned()));
        } else {
            line = longer;
        }
    }
    lines.push(line);
    for line in lines.iter().filter(|l| !l.is_empty()).take(3) {
        base += 17.5;
        svg.text("name", [18.0, base], Anchor::Start, line);
    }
    base + 6.0
}

fn overlay_of(d: &Drawing<'_>, moved: &Moved, scene: &Scene) -> Overlay {
    let from = Scene::with_unit(d.mechanism, &moved.from, scene.unit);
    let to = Scene::with_unit(d.mechanism, &moved.to, scene.unit);
    let displacement = to.tool.translation.vector - from.tool.translation.vector;
    let most = from
        .bars
        .iter()
        .zip(&to.bars)
        .flat_map(|(a, b)| {
            [
                b.ends[0] - a.ends[0],
                b.ends[1] - a.ends[1],
                b.bow() - a.bow(),
            ]
        })
        .map(|v| v.norm())
        .fold(displacement.norm(), f64::max);
    let fitting = if most > 0.0 {
        0.13 * scene.size / most
    } else {
        1.0
    };
    let factor = match moved.magnified {
        Magnified::Times(factor) => factor,
        Magnified::Direction => fitting,
        Magnified::Round => round_below(fitting),
    };
    let on = |p: &Vector3<f64>, a: &Vector3<f64>, b: &Vector3<f64>| p + (b - a) * factor;
    let bars = scene.bars.iter().zip(from.bars.iter().zip(&to.bars));
    let plates = scene.plates.iter().zip(from.plates.iter().zip(&to.plates));
    Overlay {
        bars: bars
            .map(|(own, (a, b))| Bar {
                ends: std::array::from_fn(|k| on(&own.ends[k], &a.ends[k], &b.ends[k])),
                tangents: std::array::from_fn(|k| {
                    on(&own.tangents[k], &a.tangents[k], &b.tangents[k])
                }),
                ..own.clone()
            })
            .collect(),
        plates: plates
            .filter(|(own, _)| !own.base)
            .map(|(own, (a, b))| {
                let points = own.points.iter().zip(a.points.iter().zip(&b.points));
                points.map(|(p, (a, b))| on(p, a, b)).collect()
            })
            .collect(),
        tool: scene.tool.translation.vector + displacement * factor,
        factor,
    }
}

/// 1, 2 or 5 times a power of ten.
fn round_below(value: f64) -> f64 {
    let ten = 10_f64.powf(value.max(1e-12).log10().floor());
    let step = [5.0, 2.0, 1.0].into_iter().find(|s| s * ten <= value);
    step.unwrap_or(1.0) * ten
}

/// A bar on paper: what lies between `trim` pixels from its ends.
fn case(ends: &[Point; 2]) -> Option<[Point; 2]> {
    let along = ends[1] - ends[0];
    let length = along.xy().norm();
    let trim = 9.0;
    (length > 2.5 * trim).then(|| {
        let step = along * (trim / length);
        [ends[0] + step, ends[1] - step]
    })
}

fn machine(svg: &mut Svg, names: &mut Names, scene: &Scene, paper: &Paper) {
    let ends: Vec<[Point; 2]> = scene
        .bars
        .iter()
        .map(|b| b.ends.map(|p| paper.at(&p)))
        .collect();
    let centres: Vec<Point> = scene.blobs.iter().map(|b| paper.at(&b.at)).collect();
    let plates: Vec<Vec<Point>> = scene
        .plates
        .iter()
        .map(|p| {
            let points: Vec<Point> = p.points.iter().map(|p| paper.at(p)).collect();
            let flat: Vec<_> = points.iter().map(|p| p.xy()).collect();
            rim(&flat).into_iter().map(|i| points[i]).collect()
        })
        .collect();
    let mut things: Vec<Thing> = ends.iter().map(|e| Thing::Line(*e)).collect();
    for (blob, at) in scene.blobs.iter().zip(&centres) {
        let half = blob.half * paper.scale;
        things.push(match blob.kind {
            BlobKind::Sleeve if half > 20.0 => {
                let along = paper.direction(&blob.axis) * half;
                Thing::Line([at - along, at + along])
            }
            BlobKind::Motor | BlobKind::Sleeve | BlobKind::Slide => Thing::Joint(*at, 11.0, 0),
            _ => Thing::Joint(*at, symbol::JOINT, 1),
        });
    }
    things.extend(plates.iter().map(|p| Thing::Plate(p.clone())));
    for index in painting_order(&things) {
        if index < ends.len() {
            bar(svg, scene.bars[index].kind, &ends[index]);
        } else if index < ends.len() + centres.len() {
            let k = index - ends.len();
            blob(svg, &scene.blobs[k], &centres[k], paper);
        } else {
            let k = index - ends.len() - centres.len();
            let class = if scene.plates[k].base {
                "base"
            } else {
                "plate"
            };
            svg.path(class, &symbol::polygon(plates[k].iter().map(flat)));
        }
    }
    for (bar, e) in scene.bars.iter().zip(&ends) {
        let half = if bar.kind == BarKind::Spring {
            6.0
        } else {
            3.0
        };
        names.line(&[Some(flat(&e[0])), Some(flat(&e[1]))], half);
    }
    for (blob, at) in scene.blobs.iter().zip(&centres) {
        let along = paper.direction(&blob.axis) * (blob.half * paper.scale);
        let (from, to) = (flat(&(at - along)), flat(&(at + along)));
        match blob.kind {
            BlobKind::Motor => names.bar(from, to, symbol::MOTOR),
            BlobKind::Sleeve | BlobKind::Slide => names.bar(from, to, symbol::SLEEVE + 1.0),
            _ => names.mark(flat(at), symbol::JOINT + 2.0),
        }
    }
}

fn bar(svg: &mut Svg, kind: BarKind, ends: &[Point; 2]) {
    let [a, b] = ends.map(|p| flat(&p));
    if (a[0] - b[0]).hypot(a[1] - b[1]) < 0.5 {
        return;
    }
    if matches!(kind, BarKind::Ram | BarKind::Twice) {
        return;
    }
    if let Some([from, to]) = case(ends) {
        svg.line("case", flat(&from), flat(&to));
    }
    match kind {
        BarKind::Rigid => svg.line("rigid", a, b),
        BarKind::Elastic => svg.line("elastic", a, b),
        BarKind::Rod => svg.line("rod", a, b),
        BarKind::Rail => {
            svg.line("rail", a, b);
            svg.line("rail-in", a, b);
        }
        BarKind::Spring => {
            svg.path("coil", &symbol::coil(&ends[0], &ends[1]));
            svg.path("joint", &symbol::circle(a, 3.0));
            svg.path("joint", &symbol::circle(b, 3.0));
        }
        BarKind::Ram | BarKind::Twice => {}
    }
}

fn blob(svg: &mut Svg, blob: &Blob, at: &Point, paper: &Paper) {
    let (axis, across) = (paper.direction(&blob.axis), paper.direction(&blob.across));
    let half = blob.half * paper.scale;
    match blob.kind {
        BlobKind::Motor => symbol::motor(svg, at, &axis, &across, half),
        BlobKind::Sleeve => symbol::sleeve(svg, "drive", at, &axis, &across, half),
        BlobKind::Slide => symbol::sleeve(svg, "slide", at, &axis, &across, half),
        BlobKind::Turn => symbol::turn(svg, flat(at), &axis),
        BlobKind::Universal => symbol::universal(svg, flat(at)),
        BlobKind::Spherical => symbol::spherical(svg, flat(at)),
        BlobKind::Spring => symbol::spring_joint(svg, flat(at)),
    }
}

fn motion(svg: &mut Svg, names: &mut Names, scene: &Scene, o: &Overlay, paper: &Paper) {
    for plate in &o.plates {
        let points: Vec<_> = plate.iter().map(|p| paper.at(p)).collect();
        let all: Vec<_> = points.iter().map(|p| p.xy()).collect();
        let rim = rim(&all);
        let data = symbol::polygon(rim.iter().map(|&i| flat(&points[i])));
        svg.path("moved-plate", &data);
    }
    for bar in o
        .bars
        .iter()
        .filter(|b| !matches!(b.kind, BarKind::Rail | BarKind::Rod | BarKind::Twice))
    {
        let ends = bar.ends.map(|p| paper.at(&p));
        let tangents = bar.tangents.map(|t| paper.direction(&t) * paper.scale);
        if (ends[0] - ends[1]).xy().norm() > 0.5 {
            svg.path("moved", &symbol::curve(&ends, &tangents));
        }
        names.line(&[Some(flat(&ends[0])), Some(flat(&ends[1]))], 1.5);
    }
    let from = paper.at(&scene.tool.translation.vector);
    let to = paper.at(&o.tool);
    if (from - to).xy().norm() > 3.0 {
        symbol::arrow(svg, "way", flat(&from), flat(&to));
    }
    svg.path("way head", &symbol::circle(flat(&to), 3.0));
}

/// A frame: origin and ends of x, y, z.
struct Axes {
    ends: [Vector3<f64>; 4],
    name: &'static str,
}

fn axes(scene: &Scene) -> Vec<Axes> {
    let length = AXIS * scene.unit;
    let triad = |pose: &kinetostat::Pose, name| {
        let origin = pose.translation.vector;
        let mut ends = [origin; 4];
        for k in 0..3 {
            let mut axis = Vector3::zeros();
            axis[k] = length;
            ends[k + 1] = origin + pose.rotation * axis;
        }
        Axes { ends, name }
    };
    let tool = triad(&scene.tool, "tool");
    let base = triad(&kinetostat::Pose::identity(), "base");
    let points = scene.bars.iter().flat_map(|b| b.ends);
    let near = super::scene::corners(points).is_some_and(|(low, high)| {
        let out = (low - base.ends[0]).sup(&(base.ends[0] - high));
        out.max() < 0.35 * scene.size
    });
    let apart = scene.tool.translation.vector.norm() > 0.06 * scene.size;
    match (near, apart) {
        (true, true) => vec![base, tool],
        (true, false) if scene.tool.rotation.angle() < 1e-6 => vec![Axes {
            name: "tool, base",
            ..tool
        }],
        _ => vec![tool],
    }
}

impl Axes {
    /// The arrows.
    fn draw(&self, svg: &mut Svg, names: &mut Names, paper: &Paper) {
        let ends = self.ends.map(|p| paper.at(&p));
        // The axis that comes to the eye is drawn last.
        let mut order = [1, 2, 3];
        order.sort_by(|&i, &j| ends[i].z.total_cmp(&ends[j].z));
        for k in order {
            let class = ["ax", "ay", "az"][k - 1];
            symbol::arrow(svg, class, flat(&ends[0]), flat(&ends[k]));
            names.line(&[Some(flat(&ends[0])), Some(flat(&ends[k]))], 1.5);
        }
    }

    /// The letters of those that can be seen, each beyond its tip if it can be, and the frame's name.
    fn name(&self, svg: &mut Svg, names: &mut Names, paper: &Paper) {
        let ends = self.ends.map(|p| flat(&paper.at(&p)));
        let origin = ends[0];
        for k in 1..4 {
            let (dx, dy) = (ends[k][0] - origin[0], ends[k][1] - origin[1]);
            let length = dx.hypot(dy);
            if length < 7.0 {
                continue;
            }
            let beside = Beside {
                at: ends[k],
                radius: 0.0,
                toward: [dx / length, dy / length],
            };
            names.write_as(svg, "letter", &beside, ["x", "y", "z"][k - 1]);
        }
        names.write_as(svg, "mark-name", &Beside::point(origin, 6.0), self.name);
    }
}

/// Lower left; returns where the legend may begin.
fn scale_bar(svg: &mut Svg, scale: f64, height: f64) -> f64 {
    let length = round_below(150.0 / (1e-3 * scale).max(1e-30));
    let pixels = length * 1e-3 * scale;
    let (x, y) = (20.0, height - 24.0);
    for (from, to) in [
        ([x, y], [x + pixels, y]),
        ([x, y - 4.0], [x, y + 4.0]),
        ([x + pixels, y - 4.0], [x + pixels, y + 4.0]),
    ] {
        svg.line("scale", from, to);
    }
    let label = format!("{length} mm");
    svg.text("tick", [x + 0.5 * pixels, y - 8.0], Anchor::Middle, &label);
    x + pixels + 34.0
}

/// Symbol of the legend.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Key {
    Elastic,
    Rigid,
    Drive,
    Passive,
    Spring,
    Moved,
}

fn entries(scene: &Scene, d: &Drawing<'_>, factor: f64) -> Vec<(Key, String)> {
    let mut keys = BTreeSet::new();
    for bar in &scene.bars {
        match bar.kind {
            BarKind::Elastic => keys.insert(Key::Elastic),
            BarKind::Rigid if bar.length() > 0.02 * scene.size => keys.insert(Key::Rigid),
            BarKind::Spring => keys.insert(Key::Spring),
            _ => false,
        };
    }
    for blob in &scene.blobs {
        keys.insert(match blob.kind {
            BlobKind::Motor | BlobKind::Sleeve => Key::Drive,
            BlobKind::Spring => Key::Spring,
            _ => Key::Passive,
        });
    }
    if d.moved.is_some() {
        keys.insert(Key::Moved);
    }
    let name = |key: Key| match (key, &d.moved) {
        (Key::Elastic, _) => "link that bends".to_owned(),
        (Key::Rigid, _) => "rigid".to_owned(),
        (Key::Drive, _) => "drive".to_owned(),
        (Key::Passive, _) => "passive joint".to_owned(),
        (Key::Spring, _) => "spring".to_owned(),
        (Key::Moved, Some(m)) if m.magnified != Magnified::Direction => {
            let shown = crate::number::setting(factor);
            if factor < 1.0 {
                format!("{}, drawn at {shown} times its size", m.name)
            } else {
                format!("{}, {shown} times larger", m.name)
            }
        }
        (Key::Moved, Some(m)) => m.name.clone(),
        (Key::Moved, None) => String::new(),
    };
    keys.into_iter().map(|k| (k, name(k))).collect()
}

fn legend(svg: &mut Svg, entries: &[(Key, String)], left: f64, height: f64) {
    let width = |e: &(Key, String)| 26.0 + 1.05 * text::width(&e.1, TEXT_SIZE) + 16.0;
    let total: f64 = entries.iter().map(width).sum();
    let two = total > WIDTH - 14.0 - left;
    let mut y = height - if two { 34.0 } else { 24.0 };
    // Placed at the right, so that it stays away from the scale.
    let mut x = if two { left } else { WIDTH - 6.0 - total };
    for entry in entries {
        if two && x > left && x + width(entry) > WIDTH - 4.0 {
            x = left;
            y += 20.0;
        }
        let middle = [x + 10.0, y];
        let line = |svg: &mut Svg, class: &str| svg.line(class, [x + 1.0, y], [x + 19.0, y]);
        match entry.0 {
            Key::Elastic => line(svg, "elastic"),
            Key::Rigid => line(svg, "rigid"),
            Key::Drive => svg.rectangle("drive-key", [x + 3.0, y - 6.0], [14.0, 12.0], 2.0),
            Key::Passive => svg.path("joint", &symbol::circle(middle, symbol::JOINT)),
            Key::Spring => svg.path(
                "coil",
                &symbol::coil(&Point::new(x - 3.0, y, 0.0), &Point::new(x + 21.0, y, 0.0)),
            ),
            Key::Moved => line(svg, "moved"),
        }
        svg.text("name", [x + 26.0, y + 4.3], Anchor::Start, &entry.1);
        x += width(entry);
    }
}
