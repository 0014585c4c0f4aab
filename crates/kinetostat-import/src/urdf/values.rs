//! Places, numbers, directions and origins of the XML.

use std::collections::BTreeMap;

use roxmltree::Node;

use crate::log::{At, Log};
use crate::urdf::robot::Origin;
use kinetostat::number::largest_size;

/// Limits beyond this are none, rad or m.
const NO_LIMIT: f64 = 1e9;

impl Reader<'_> {
    pub(crate) fn at(&self, node: Node<'_, '_>, element: &str) -> At {
        // The opening tag, without what it holds.
        let range = node.range();
        let text = &node.document().input_text()[range.clone()];
        let length = text.find('>').map_or(text.len(), |i| i + 1);
        At {
            file: self.file,
            span: range.start..range.start + length,
            element: element.to_owned(),
        }
    }

    pub(crate) fn at_value(&self, node: Node<'_, '_>, attribute: &str, element: &str) -> At {
        match node.attribute_node(attribute) {
            Some(a) => At {
                file: self.file,
                span: a.range_value(),
                element: element.to_owned(),
            },
            None => self.at(node, element),
        }
    }

    /// Attributes that are read; others are refused where they are near to one of these.
    pub(crate) fn attributes(&mut self, node: Node<'_, '_>, known: &[&str], element: &str) {
        for a in node.attributes() {
            let name = a.name();
            let near = known
                .iter()
                .find(|k| strsim::damerau_levenshtein(k, name) <= 2);
            if let (false, Some(near)) = (known.contains(&name), near) {
                let at = At {
                    file: self.file,
                    span: a.range_qname(),
                    element: element.to_owned(),
                };
                self.log.error(
                    &at,
                    format!("the attribute '{name}' is unknown"),
                    format!("did you mean '{near}'?"),
                );
            }
        }
    }

    /// `<origin xyz rpy>` or an element of another name with these attributes; zero if absent.
    pub(crate) fn origin(
        &mut self,
        parent: Node<'_, '_>,
        tag: &str,
        element: &str,
    ) -> Option<Origin> {
        let Some(node) = only(parent, tag) else {
            return Some(Origin::default());
        };
        let element = format!("{element} / {tag}");
        if children(parent, tag).count() > 1 {
            let at = self.at(node, &element);
            self.log
                .error(&at, "it is written twice", "keep one of them");
            return None;
        }
        self.attributes(node, &["xyz", "rpy"], &element);
        let xyz = self.triple(node, "xyz", [0.0; 3], &element);
        let rpy = self.triple(node, "rpy", [0.0; 3], &element);
        let origin = Origin {
            xyz: xyz?,
            rpy: rpy?,
        };
        if origin.xyz.iter().any(|x| x.abs() > 50.0) {
            let at = self.at_value(node, "xyz", &element);
            self.log.notice(
                &at,
                format!("an offset is {:.1} m long", largest_size(origin.xyz)),
                "lengths of a URDF are metres; are these millimetres?",
            );
        }
        if origin.rpy.iter().any(|x| x.abs() > 6.4) {
            let at = self.at_value(node, "rpy", &element);
            self.log.notice(
                &at,
                "an angle is larger than a full turn",
                "angles of a URDF are radians; are these degrees?",
            );
        }
        Some(origin)
    }

    pub(crate) fn word(&mut self, text: &str, at: &At) -> Option<f64> {
        let help = if text.contains("${") || text.contains("$(") {
            &format!(
                "this is a xacro expression; {}",
                self.log.expansion(self.file)
            )
        } else if text.contains(',') {
            "write numbers with a point and spaces between them"
        } else {
            "write a finite number"
        };
        match text.parse::<f64>() {
            Ok(x) if x.is_finite() && x.abs() <= 1e15 => Some(x),
            Ok(x) => {
                self.log.error(at, format!("the value is {x:?}"), help);
                None
            }
            Err(_) => {
                let shown: String = text.chars().take(40).collect();
                self.log.error(at, format!("'{shown}' is no number"), help);
                None
            }
        }
    }

    /// A limit; infinite where it is one that nothing reaches, whose sign counts.
    pub(crate) fn bound(
        &mut self,
        node: Node<'_, '_>,
        attribute: &str,
        element: &str,
    ) -> Option<f64> {
        let text = node.attribute(attribute).map(str::trim).unwrap_or("0");
        match text.parse::<f64>() {
            Ok(x) if x.abs() > NO_LIMIT => Some(x.signum() * f64::INFINITY),
            _ => self.number(node, attribute, Some(0.0), element),
        }
    }

    /// A number; `default` stands in for a missing attribute.
    pub(crate) fn number(
        &mut self,
        node: Node<'_, '_>,
        attribute: &str,
        default: Option<f64>,
        element: &str,
    ) -> Option<f64> {
        let at = self.at_value(node, attribute, element);
        match (node.attribute(attribute), default) {
            (Some(text), _) => self.word(text.trim(), &at),
            (None, Some(default)) => Some(default),
            (None, None) => {
                self.log.error(
                    &at,
                    format!("the attribute '{attribute}' is missing"),
                    format!("write {attribute}=\"...\""),
                );
                None
            }
        }
    }

    pub(crate) fn triple(
        &mut self,
        node: Node<'_, '_>,
        attribute: &str,
        default: [f64; 3],
        element: &str,
    ) -> Option<[f64; 3]> {
        let Some(text) = node.attribute(attribute) else {
            return Some(default);
        };
        let at = self.at_value(node, attribute, element);
        let words: Vec<&str> = text.split_whitespace().take(5).collect();
        if words.len() != 3 {
            let help = match words.iter().any(|w| w.contains(',')) {
                true => "write numbers with a point and spaces between them",
                false => "write x y z with spaces between them",
            };
            self.log
                .error(&at, format!("'{attribute}' needs three numbers"), help);
            return None;
        }
        let found: Vec<Option<f64>> = words.iter().map(|w| self.word(w, &at)).collect();
        match found[..] {
            [Some(x), Some(y), Some(z)] => Some([x, y, z]),
            _ => None,
        }
    }

    /// A direction of any length but zero.
    pub(crate) fn axis(
        &mut self,
        parent: Node<'_, '_>,
        tag: &str,
        element: &str,
    ) -> Option<Option<[f64; 3]>> {
        let Some(node) = only(parent, tag) else {
            return Some(None);
        };
        let element = format!("{element} / {tag}");
        self.attributes(node, &["xyz"], &element);
        let axis = self.triple(node, "xyz", [1.0, 0.0, 0.0], &element)?;
        let at = self.at_value(node, "xyz", &element);
        let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length < 1e-9 {
            self.log.error(
                &at,
                "the axis has no direction",
                "write one as in xyz=\"0 0 1\"",
            );
            return None;
        }
        if (length - 1.0).abs() > 1e-3 {
            self.log.notice(
                &at,
                format!("the axis has the length {length:.4}, not 1"),
                "only its direction is used",
            );
        }
        Some(Some(axis))
    }
}

pub(crate) fn children<'a, 'i: 'a>(
    node: Node<'a, 'i>,
    tag: &'a str,
) -> impl Iterator<Item = Node<'a, 'i>> + 'a {
    node.children()
        .filter(move |n| n.is_element() && n.tag_name().name() == tag)
}

/// The first child element of this name.
pub(crate) fn only<'a, 'i: 'a>(node: Node<'a, 'i>, tag: &str) -> Option<Node<'a, 'i>> {
    node.children()
        .find(|n| n.is_element() && n.tag_name().name() == tag)
}

pub(crate) struct Reader<'l> {
    pub(crate) log: &'l mut Log,
    pub(crate) file: usize,
    pub(crate) skipped: BTreeMap<String, usize>,
}
