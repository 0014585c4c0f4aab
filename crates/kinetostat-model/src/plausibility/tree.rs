//! Every number of a tree of tables and lists, with its key and its place: one traversal for documents,
//! which have no text,
//! and for texts, whose numbers know where they stand.

use serde_json::Value;
use serde_spanned::Spanned;
use toml::de::DeValue;

use crate::problem::KeyPath;

/// A value of a document or of a text.
pub(crate) trait Tree: Sized {
    /// The number that it is; none for tables, lists and words.
    fn number(&self) -> Option<f64>;

    /// Children in order, with their keys in a table, without in a list.
    fn children(&self) -> Vec<(Option<&str>, &Self)>;
}

impl Tree for Value {
    fn number(&self) -> Option<f64> {
        self.as_f64()
    }

    fn children(&self) -> Vec<(Option<&str>, &Self)> {
        match self {
            Self::Object(map) => map.iter().map(|(k, v)| (Some(k.as_str()), v)).collect(),
            Self::Array(list) => list.iter().map(|v| (None, v)).collect(),
            _ => Vec::new(),
        }
    }
}

impl Tree for Spanned<DeValue<'_>> {
    fn number(&self) -> Option<f64> {
        match self.get_ref() {
            DeValue::Float(number) => number.as_str().parse().ok(),
            DeValue::Integer(number) => number.as_str().parse().ok(),
            _ => None,
        }
    }

    fn children(&self) -> Vec<(Option<&str>, &Self)> {
        match self.get_ref() {
            DeValue::Table(table) => table
                .iter()
                .map(|(k, v)| (Some(&**k.get_ref()), v))
                .collect(),
            DeValue::Array(list) => list.iter().map(|v| (None, v)).collect(),
            _ => Vec::new(),
        }
    }
}

/// A number of a tree.
pub(crate) struct Number<'t, T> {
    /// Key of the number, or of the list that contains it.
    pub(crate) key: &'t str,
    /// The path to it from the root.
    pub(crate) place: KeyPath,
    /// The value that holds it.
    pub(crate) node: &'t T,
    pub(crate) value: f64,
}

/// All numbers of a tree, in the order of its tables and lists.
pub(crate) fn numbers<T: Tree>(root: &T) -> Vec<Number<'_, T>> {
    let mut found = Vec::new();
    collect(root, "", &KeyPath::root(), &mut found);
    found
}

fn collect<'t, T: Tree>(
    node: &'t T,
    key: &'t str,
    place: &KeyPath,
    found: &mut Vec<Number<'t, T>>,
) {
    if let Some(value) = node.number() {
        found.push(Number {
            key,
            place: place.clone(),
            node,
            value,
        });
    }
    for (index, (own, child)) in node.children().into_iter().enumerate() {
        match own {
            Some(own) => collect(child, own, &place.key(own), found),
            None => collect(child, key, &place.index(index), found),
        }
    }
}
