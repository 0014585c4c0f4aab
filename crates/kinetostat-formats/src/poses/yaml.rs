//! Rasters of poses in YAML: lists whose items have a `position`.

use std::ops::Range;

use crate::options::LengthUnit;
use crate::poses::cells::number_of;
use crate::poses::columns::{Column, Refusal, column_of};
use crate::poses::layout::{Layout, Named, layout_of};
use crate::poses::row::{PART, RowContext, Rows, row_of};
use crate::poses::tree::{Kind, Node, Tree};
use crate::text::source::SourceFile;

/// Content of a YAML file.
#[derive(Debug, Default)]
pub(crate) struct YamlRows {
    pub rows: Rows,
    /// Unit, if names state it.
    pub unit: Option<LengthUnit>,
    /// The file has headers of ROS messages, whose lengths are metres by definition.
    pub is_ros: bool,
    /// The names of the last item, and what they mean: those of the next one are mostly the same.
    last: (Vec<Named>, Layout),
}

/// Reads the rasters of a file.
pub(crate) fn read_yaml(file: &SourceFile) -> YamlRows {
    let mut found = YamlRows::default();
    match Tree::of(file.bytes()) {
        Ok(tree) => {
            for document in tree.documents() {
                found.walk(file, document, "poses", PART);
            }
            if found.rows.rows.is_empty() && found.rows.faults.is_empty() {
                found.rows.fault(
                    file,
                    &line_from(file, 0),
                    "no list of poses stands in the file",
                    "write items with `position: {x: 0.1, y: 0.2, z: 0.3}` and, where it is stated, `orientation: {w: 1, x: 0, y: 0, z: 0}`",
                );
            }
        }
        Err((at, reason, remedy)) => {
            found.rows.fault(file, &line_from(file, at), reason, remedy);
        }
    }
    found
}

/// From a place to the end of its line.
fn line_from(file: &SourceFile, at: usize) -> Range<usize> {
    let rest = &file.bytes()[at..];
    let end = rest.iter().position(|byte| *byte == b'\n');
    at..at + end.unwrap_or(rest.len())
}

/// The value of a key of a map.
fn value<'t>(file: &SourceFile, map: Node<'t>, name: &str) -> Option<Node<'t>> {
    let is = |(key, _): &(Node<'t>, Node<'t>)| file.part(&key.span()) == name.as_bytes();
    map.pairs().find(is).map(|(_, value)| value)
}

/// The value of a key where it is a map.
fn map_of<'t>(file: &SourceFile, map: Node<'t>, name: &str) -> Option<Node<'t>> {
    value(file, map, name).filter(|value| value.kind() == Kind::Map)
}

/// The map that says a pose: the item itself, or its `pose` (ROS: `PoseStamped`).
fn pose_of<'t>(file: &SourceFile, item: Node<'t>) -> Option<Node<'t>> {
    let states = |map: Node<'t>, name: &str| value(file, map, name).is_some();
    let inner = map_of(file, item, "pose").filter(|inner| states(*inner, "position"));
    let own = ["position", "x_mm", "x_m"].iter();
    inner.or_else(|| {
        own.into_iter()
            .any(|name| states(item, name))
            .then_some(item)
    })
}

/// True if an item is a position without names, in a list of poses.
fn is_list_of_numbers(file: &SourceFile, item: Node<'_>, key: &str) -> bool {
    let is_number = |part: Node<'_>| number_of(file.bytes(), &part.span()).is_some();
    item.kind() == Kind::List
        && matches!(key, "poses" | "points" | "waypoints" | "positions")
        && item.held().count() >= 3
        && item.held().all(is_number)
}

const ALIAS: Refusal = (
    "an alias: what it stands for is written elsewhere, once for several places",
    "write the numbers themselves",
);

const IN_LINE: &str = "the pose does not stand on lines of its own: none can be written before it";

impl YamlRows {
    fn walk(&mut self, file: &SourceFile, node: Node<'_>, key: &str, frame: &str) {
        match node.kind() {
            Kind::List => {
                let is_pose = |item: Node<'_>| {
                    pose_of(file, item).is_some() || is_list_of_numbers(file, item, key)
                };
                if node.held().any(is_pose) {
                    self.raster(file, node, frame);
                    return;
                }
                for item in node.held() {
                    self.walk(file, item, key, frame);
                }
            }
            Kind::Map => {
                if pose_of(file, node).is_some() {
                    self.alone(file, node, key);
                    return;
                }
                let mut own = frame.to_owned();
                if let Some(header) = map_of(file, node, "header") {
                    self.is_ros |= value(file, header, "stamp").is_some()
                        && value(file, header, "frame_id").is_some();
                    own = frame_id(file, header).unwrap_or(own);
                }
                for (name, node) in node.pairs() {
                    let name = String::from_utf8_lossy(file.part(&name.span())).into_owned();
                    self.walk(file, node, &name, &own);
                }
            }
            Kind::Alias => {
                self.rows.fault(file, &node.span(), ALIAS.0, ALIAS.1);
            }
            Kind::Scalar => {}
        }
    }

    /// A pose that stands in no list: of a tool, a frame, a start.
    fn alone(&mut self, file: &SourceFile, node: Node<'_>, key: &str) {
        let numbers: Vec<Option<f64>> = match map_of(file, node, "position") {
            Some(place) => (place.pairs())
                .map(|(_, part)| Some(number_of(file.bytes(), &part.span())?.value))
                .collect(),
            None => vec![None],
        };
        let is_zero = numbers.iter().all(|number| *number == Some(0.0));
        if key.contains("offset") && !is_zero {
            self.rows.fault(
                file,
                &node.span(),
                format!("`{key}` moves the tool, and to which poses it applies is not known"),
                "apply it to the poses, and set its position to 0",
            );
            return;
        }
        let message = format!("`{key}` is a pose in no list: it is carried, not followed");
        self.rows.findings.push((node.span().start, message));
    }

    fn raster(&mut self, file: &SourceFile, list: Node<'_>, frame: &str) {
        let mut first = true;
        for item in list.held() {
            self.item(file, item, frame, first);
            first = false;
        }
    }

    fn item(&mut self, file: &SourceFile, item: Node<'_>, frame: &str, first: bool) {
        let mut cells: Vec<(Named, Range<usize>)> = Vec::new();
        let before = self.rows.faults.len();
        let mut own = frame.to_owned();
        match (item.kind(), pose_of(file, item)) {
            (Kind::Map, Some(pose)) => {
                if let Some(header) = map_of(file, item, "header") {
                    own = frame_id(file, header).unwrap_or(own);
                    self.is_ros |= value(file, header, "stamp").is_some();
                }
                self.keys(file, pose, &mut cells);
                if !pose.is_node(item) {
                    self.keys(file, item, &mut cells);
                }
            }
            (Kind::List, _) => self.numbers(file, item, &mut cells),
            _ => {
                let reason = "it has no `position`, as the others of its list have";
                let remedy = "write its position, or take it out";
                self.rows.fault(file, &item.span(), reason, remedy);
            }
        }
        if self.rows.faults.len() > before {
            return;
        }
        let known = &self.last.0;
        let mut pairs = known.iter().zip(&cells);
        let same =
            known.len() == cells.len() && pairs.all(|(own, (named, _))| own.name == named.name);
        if !same || cells.is_empty() {
            let names: Vec<Named> = cells.iter().map(|(named, _)| named.clone()).collect();
            match layout_of(&names, &item.span()) {
                Ok(layout) => self.last = (names, layout),
                Err(faults) => {
                    for (span, reason, remedy) in faults {
                        self.rows.fault(file, &span, reason, remedy);
                    }
                    return;
                }
            }
        }
        let layout = &self.last.1;
        if self.unit.is_some() && self.unit != layout.unit {
            let reason = "its place is in another unit than the ones before";
            let remedy = "write all places in one unit";
            self.rows.fault(file, &item.span(), reason, remedy);
            return;
        }
        self.unit = layout.unit;
        let spans: Vec<Range<usize>> = cells.into_iter().map(|(_, span)| span).collect();
        let dash = dash_of(file, item);
        let context = RowContext {
            layout,
            span: dash.unwrap_or(item.span().start)..item.span().end,
            first,
            frame: &own,
            indivisible: match dash {
                Some(_) => None,
                None => Some(IN_LINE),
            },
        };
        let row = row_of(file, context, &spans, &mut self.rows);
        self.rows.rows.extend(row);
    }

    /// The keys of a pose, as names of columns.
    fn keys(&mut self, file: &SourceFile, map: Node<'_>, cells: &mut Vec<(Named, Range<usize>)>) {
        for (key, node) in map.pairs() {
            let (at, span) = (key.span(), node.span());
            let name = String::from_utf8_lossy(file.part(&at)).into_owned();
            match (name.as_str(), node.kind()) {
                (_, Kind::Alias) => self.rows.fault(file, &span, ALIAS.0, ALIAS.1),
                ("position", Kind::List) => self.numbers(file, node, cells),
                ("position", Kind::Map) => self.parts(file, node, "", cells),
                ("orientation", Kind::Map) => self.parts(file, node, "q", cells),
                ("position", _) => self.rows.fault(
                    file,
                    &span,
                    "the place is not x, y, z",
                    "write  position: {x: 0.1, y: 0.2, z: 0.3}",
                ),
                ("orientation", _) => self.rows.fault(
                    file,
                    &(at.start..span.end.max(at.end)),
                    "the orientation is not w, x, y, z: of numbers without names it is not known whether w is the first or the last",
                    "write  orientation: {w: 1, x: 0, y: 0, z: 0}",
                ),
                ("pose" | "header", Kind::Map) => {}
                (_, Kind::Scalar) => cells.push((Named { name, span: at }, span)),
                // A value that is no number moves nothing, unless its name implies it.
                _ => {
                    if let Err((reason, remedy)) = column_of(&name) {
                        self.rows.fault(file, &at, reason, remedy);
                    }
                }
            }
        }
    }

    /// x, y, z of a position or w, x, y, z of an orientation.
    fn parts(
        &mut self,
        file: &SourceFile,
        map: Node<'_>,
        prefix: &str,
        cells: &mut Vec<(Named, Range<usize>)>,
    ) {
        for (key, node) in map.pairs() {
            let span = key.span();
            let own = String::from_utf8_lossy(file.part(&span)).into_owned();
            let name = match own.len() {
                1 => format!("{prefix}{own}"),
                _ => own,
            };
            let fits = match column_of(&name) {
                Ok(Column::Position(..)) => prefix.is_empty(),
                Ok(Column::Orientation(..)) => !prefix.is_empty(),
                _ => false,
            };
            if !fits {
                let reason = "what this is of a pose is not known";
                let remedy = "write x, y, z in a position, and w, x, y, z in an orientation";
                self.rows.fault(file, &span, reason, remedy);
                continue;
            }
            cells.push((Named { name, span }, node.span()));
        }
    }

    /// Three numbers without names: x, y, z.
    fn numbers(
        &mut self,
        file: &SourceFile,
        list: Node<'_>,
        cells: &mut Vec<(Named, Range<usize>)>,
    ) {
        let count = list.held().count();
        if count != 3 {
            let reason = format!(
                "{count} numbers without names: which of them are the orientation, and whether w is its first or its last, is not known"
            );
            let remedy = "write  - {position: {x: .., y: .., z: ..}, orientation: {w: .., x: .., y: .., z: ..}}, or three numbers where no orientation is stated";
            self.rows.fault(file, &list.span(), reason, remedy);
            return;
        }
        for (part, name) in list.held().zip(["x", "y", "z"]) {
            let span = part.span();
            let named = Named {
                name: name.to_owned(),
                span: span.clone(),
            };
            cells.push((named, span));
        }
    }
}

/// Frame of a header of ROS; none where it is empty or the zero that some writers put there.
fn frame_id(file: &SourceFile, header: Node<'_>) -> Option<String> {
    let node = value(file, header, "frame_id")?;
    let text = String::from_utf8_lossy(file.part(&node.span()));
    let name = text.trim_matches(|c| matches!(c, '"' | '\''));
    (!matches!(name, "" | "0" | "~" | "null")).then(|| name.to_owned())
}

/// The dash of an item, where it is the first on its line and the item can be written a second time before it.
fn dash_of(file: &SourceFile, item: Node<'_>) -> Option<usize> {
    let bytes = file.bytes();
    let is_space = |byte: &u8| *byte == b' ';
    let start = item.span().start;
    let before = bytes[..start].iter().rev();
    let spaces = before.take_while(|byte| is_space(byte)).count();
    let dash = start.checked_sub(spaces + 1)?;
    if spaces == 0 || bytes[dash] != b'-' {
        return None;
    }
    let line = bytes[..dash]
        .iter()
        .rev()
        .take_while(|byte| **byte != b'\n');
    let first = line.clone().all(is_space);
    // Texts over several lines have an indentation that counts.
    (first && whole(file, item)).then_some(dash)
}

/// True if no text in a node spans several lines.
fn whole(file: &SourceFile, node: Node<'_>) -> bool {
    match node.kind() {
        Kind::Scalar => !file.part(&node.span()).contains(&b'\n'),
        Kind::Alias => true,
        Kind::List | Kind::Map => node.held().all(|held| whole(file, held)),
    }
}
