//! Rasters of poses in YAML: lists whose items have a `position`.

use std::ops::Range;

use crate::options::LengthUnit;
use crate::poses::cells::number_of;
use crate::poses::columns::{Column, Refusal, column_of};
use crate::poses::layout::{Layout, Named, layout_of};
use crate::poses::row::{PART, RowContext, Rows, row_of};
use crate::poses::tree::{Kind, Node, documents_of};
use crate::text::source::SourceFile;

/// What a file in YAML says.
#[derive(Debug, Default)]
pub(crate) struct YamlRows {
    pub rows: Rows,
    /// Where names say it.
    pub unit: Option<LengthUnit>,
    /// It has the headers of ROS messages, whose lengths are metres by definition.
    pub is_ros: bool,
    /// The names of the last item, and what they mean: those of the next one are mostly the same.
    last: (Vec<Named>, Layout),
}

/// Reads the rasters of a file.
pub(crate) fn read_yaml(file: &SourceFile) -> YamlRows {
    let mut found = YamlRows::default();
    match documents_of(file.bytes()) {
        Ok(documents) => {
            for document in &documents {
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

/// The value of a key.
fn value<'n>(file: &SourceFile, pairs: &'n [(Node, Node)], name: &str) -> Option<&'n Node> {
    let is = |(key, _): &&(Node, Node)| file.part(&key.span) == name.as_bytes();
    pairs.iter().find(is).map(|(_, value)| value)
}

/// The pairs that say a pose: of the item itself, or below its `pose` (ROS: `PoseStamped`).
fn pose_of<'n>(file: &SourceFile, item: &'n Node) -> Option<&'n [(Node, Node)]> {
    let Kind::Map(pairs) = &item.kind else {
        return None;
    };
    match value(file, pairs, "pose").map(|pose| &pose.kind) {
        Some(Kind::Map(inner)) if value(file, inner, "position").is_some() => Some(inner),
        _ if value(file, pairs, "position").is_some() => Some(pairs),
        _ if value(file, pairs, "x_mm")
            .or(value(file, pairs, "x_m"))
            .is_some() =>
        {
            Some(pairs)
        }
        _ => None,
    }
}

/// Whether items are places without names, in a list that holds poses.
fn is_list_of_numbers(file: &SourceFile, item: &Node, key: &str) -> bool {
    let Kind::List(parts) = &item.kind else {
        return false;
    };
    matches!(key, "poses" | "points" | "waypoints" | "positions")
        && parts.len() >= 3
        && parts
            .iter()
            .all(|part| number_of(file.bytes(), &part.span).is_some())
}

const ALIAS: Refusal = (
    "an alias: what it stands for is written elsewhere, once for several places",
    "write the numbers themselves",
);

const IN_LINE: &str = "the pose does not stand on lines of its own: none can be written before it";

impl YamlRows {
    fn walk(&mut self, file: &SourceFile, node: &Node, key: &str, frame: &str) {
        match &node.kind {
            Kind::List(items) => {
                let is_pose = |item: &Node| {
                    pose_of(file, item).is_some() || is_list_of_numbers(file, item, key)
                };
                if items.iter().any(is_pose) {
                    self.raster(file, items, frame);
                    return;
                }
                for item in items {
                    self.walk(file, item, key, frame);
                }
            }
            Kind::Map(pairs) => {
                if pose_of(file, node).is_some() {
                    self.alone(file, node, key, pairs);
                    return;
                }
                let header = value(file, pairs, "header").map(|header| &header.kind);
                let mut own = frame.to_owned();
                if let Some(Kind::Map(header)) = header {
                    self.is_ros |= value(file, header, "stamp").is_some()
                        && value(file, header, "frame_id").is_some();
                    own = frame_id(file, header).unwrap_or(own);
                }
                for (name, node) in pairs {
                    let name = String::from_utf8_lossy(file.part(&name.span)).into_owned();
                    self.walk(file, node, &name, &own);
                }
            }
            Kind::Alias => {
                self.rows.fault(file, &node.span, ALIAS.0, ALIAS.1);
            }
            Kind::Scalar { .. } => {}
        }
    }

    /// A pose that stands in no list: of a tool, a frame, a start.
    fn alone(&mut self, file: &SourceFile, node: &Node, key: &str, pairs: &[(Node, Node)]) {
        let place = value(file, pairs, "position");
        let numbers: Vec<Option<f64>> = match place.map(|place| &place.kind) {
            Some(Kind::Map(parts)) => (parts.iter())
                .map(|(_, part)| Some(number_of(file.bytes(), &part.span)?.value))
                .collect(),
            _ => vec![None],
        };
        let is_zero = numbers.iter().all(|number| *number == Some(0.0));
        if key.contains("offset") && !is_zero {
            self.rows.fault(
                file,
                &node.span,
                format!("`{key}` moves the tool, and to which poses it applies is not known"),
                "apply it to the poses, and set its position to 0",
            );
            return;
        }
        let message = format!("`{key}` is a pose in no list: it is carried, not followed");
        self.rows.findings.push((node.span.start, message));
    }

    fn raster(&mut self, file: &SourceFile, items: &[Node], frame: &str) {
        let mut first = true;
        for item in items {
            self.item(file, item, frame, first);
            first = false;
        }
    }

    fn item(&mut self, file: &SourceFile, item: &Node, frame: &str, first: bool) {
        let mut cells: Vec<(Named, Range<usize>)> = Vec::new();
        let before = self.rows.faults.len();
        let mut own = frame.to_owned();
        match (&item.kind, pose_of(file, item)) {
            (Kind::Map(pairs), Some(pose)) => {
                if let Some(Kind::Map(header)) = value(file, pairs, "header").map(|h| &h.kind) {
                    own = frame_id(file, header).unwrap_or(own);
                    self.is_ros |= value(file, header, "stamp").is_some();
                }
                self.keys(file, pose, &mut cells);
                if !std::ptr::eq(pose, pairs.as_slice()) {
                    self.keys(file, pairs, &mut cells);
                }
            }
            (Kind::List(parts), _) => self.numbers(file, item, parts, &mut cells),
            _ => {
                let reason = "it has no `position`, as the others of its list have";
                let remedy = "write its position, or take it out";
                self.rows.fault(file, &item.span, reason, remedy);
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
            match layout_of(&names, &item.span) {
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
            self.rows.fault(file, &item.span, reason, remedy);
            return;
        }
        self.unit = layout.unit;
        let spans: Vec<Range<usize>> = cells.into_iter().map(|(_, span)| span).collect();
        let dash = dash_of(file, item);
        let context = RowContext {
            layout,
            span: dash.unwrap_or(item.span.start)..item.span.end,
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
    fn keys(
        &mut self,
        file: &SourceFile,
        pairs: &[(Node, Node)],
        cells: &mut Vec<(Named, Range<usize>)>,
    ) {
        for (key, node) in pairs {
            let name = String::from_utf8_lossy(file.part(&key.span)).into_owned();
            match (name.as_str(), &node.kind) {
                (_, Kind::Alias) => self.rows.fault(file, &node.span, ALIAS.0, ALIAS.1),
                ("position", Kind::List(parts)) => self.numbers(file, node, parts, cells),
                ("position", Kind::Map(parts)) => self.parts(file, parts, "", cells),
                ("orientation", Kind::Map(parts)) => self.parts(file, parts, "q", cells),
                ("position", _) => self.rows.fault(
                    file,
                    &node.span,
                    "the place is not x, y, z",
                    "write  position: {x: 0.1, y: 0.2, z: 0.3}",
                ),
                ("orientation", _) => self.rows.fault(
                    file,
                    &(key.span.start..node.span.end.max(key.span.end)),
                    "the orientation is not w, x, y, z: of numbers without names it is not known whether w is the first or the last",
                    "write  orientation: {w: 1, x: 0, y: 0, z: 0}",
                ),
                ("pose" | "header", Kind::Map(_)) => {}
                (_, Kind::Scalar { .. }) => cells.push((
                    Named {
                        name,
                        span: key.span.clone(),
                    },
                    node.span.clone(),
                )),
                // What is no number moves nothing, unless its name says so.
                _ => {
                    if let Err((reason, remedy)) = column_of(&name) {
                        self.rows.fault(file, &key.span, reason, remedy);
                    }
                }
            }
        }
    }

    /// x, y, z of a position or w, x, y, z of an orientation.
    fn parts(
        &mut self,
        file: &SourceFile,
        parts: &[(Node, Node)],
        prefix: &str,
        cells: &mut Vec<(Named, Range<usize>)>,
    ) {
        for (key, node) in parts {
            let own = String::from_utf8_lossy(file.part(&key.span)).into_owned();
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
                self.rows.fault(file, &key.span, reason, remedy);
                continue;
            }
            let span = key.span.clone();
            cells.push((Named { name, span }, node.span.clone()));
        }
    }

    /// Three numbers without names: x, y, z.
    fn numbers(
        &mut self,
        file: &SourceFile,
        node: &Node,
        parts: &[Node],
        cells: &mut Vec<(Named, Range<usize>)>,
    ) {
        if parts.len() != 3 {
            let reason = format!(
                "{} numbers without names: which of them are the orientation, and whether w is its first or its last, is not known",
                parts.len()
            );
            let remedy = "write  - {position: {x: .., y: .., z: ..}, orientation: {w: .., x: .., y: .., z: ..}}, or three numbers where no orientation is stated";
            self.rows.fault(file, &node.span, reason, remedy);
            return;
        }
        for (part, name) in parts.iter().zip(["x", "y", "z"]) {
            let named = Named {
                name: name.to_owned(),
                span: part.span.clone(),
            };
            cells.push((named, part.span.clone()));
        }
    }
}

/// Frame of a header of ROS; none where it is empty or the zero that some writers put there.
fn frame_id(file: &SourceFile, header: &[(Node, Node)]) -> Option<String> {
    let node = value(file, header, "frame_id")?;
    let text = String::from_utf8_lossy(file.part(&node.span));
    let name = text.trim_matches(|c| matches!(c, '"' | '\''));
    (!matches!(name, "" | "0" | "~" | "null")).then(|| name.to_owned())
}

/// The dash of an item, where it is the first on its line and the item can be written a second time before it.
fn dash_of(file: &SourceFile, item: &Node) -> Option<usize> {
    let bytes = file.bytes();
    let is_space = |byte: &u8| *byte == b' ';
    let before = &bytes[..item.span.start];
    let spaces = before
        .iter()
        .rev()
        .take_while(|byte| is_space(byte))
        .count();
    let dash = item.span.start.checked_sub(spaces + 1)?;
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

/// Whether no text in a node goes over several lines.
fn whole(file: &SourceFile, node: &Node) -> bool {
    match &node.kind {
        Kind::Scalar { .. } => !file.part(&node.span).contains(&b'\n'),
        Kind::Alias => true,
        Kind::List(items) => items.iter().all(|item| whole(file, item)),
        Kind::Map(pairs) => pairs
            .iter()
            .all(|(key, value)| whole(file, key) && whole(file, value)),
    }
}
