//! Materials by name.

use std::sync::OnceLock;

use crate::error::{CutError, CutErrorKind, Result};
use crate::material::corrected::Material;
use crate::material::text;
use crate::source::{bare, nearest};

const LIBRARY: &str = include_str!("library.toml");

/// Materials in the order in which they are searched.
///
/// ```
/// use kinetostat_cutting::Materials;
///
/// let mut materials = Materials::library();
/// materials.with(Materials::read(
///     "ours.toml",
///     r#"
///         [[material]]
///         name = "C45"
///         group = "steel"
///         spread_percent = 5
///         source = "our dynamometer"
///         measured_in = { process = "milling" }
///         [material.law.linear]
///         cutting_n_per_mm2 = [1800, 700, 250]
///         edge_n_per_mm = [30, 40, 3]
///     "#,
/// )?);
/// assert_eq!(materials.find("c 45")?.source, "our dynamometer"); // ours come first
/// assert_eq!(materials.find("Ti6Al4V")?.name, "Ti-6Al-4V");
/// # Ok::<(), kinetostat_cutting::CutError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Materials {
    list: Vec<Material>,
}

impl Materials {
    /// The materials that come with this crate, with the source of each number.
    #[must_use]
    pub fn library() -> Self {
        static READ: OnceLock<Materials> = OnceLock::new();
        // A test reads the library; here it would only be empty, and nothing in it would be found.
        READ.get_or_init(|| Self::read("library.toml", LIBRARY).unwrap_or_default())
            .clone()
    }

    /// The materials of a file, whose form is that of the library; errors name the file and its line.
    ///
    /// ```
    /// use kinetostat_cutting::Materials;
    ///
    /// let error = Materials::read("ours.toml", "[[material]]\nnmae = \"wax\"").unwrap_err();
    /// assert_eq!(error.line, Some(2));
    /// assert!(error.expected.contains("did you mean `name`?"));
    /// ```
    ///
    /// # Errors
    /// What is no TOML, keys that are not known or missing, coefficients that no material has, a name of two materials, more
    /// than 10 000 materials or 10 MB.
    pub fn read(name_of_file: &str, text: &str) -> Result<Self> {
        text::read(name_of_file, text).map(|list| Self { list })
    }

    /// Takes others in, which are found before those that are here.
    pub fn with(&mut self, other: Self) -> &mut Self {
        self.list.splice(0..0, other.list);
        self
    }

    /// The material of a name or another designation; case, spaces, hyphens, dots and other signs do not matter.
    ///
    /// ```
    /// use kinetostat_cutting::Materials;
    ///
    /// let materials = Materials::library();
    /// assert_eq!(materials.find("en aw 5083")?.name, "AlMg4.5Mn");
    /// let error = materials.find("Inconell 718").unwrap_err();
    /// assert!(error.expected.contains("Inconel 718"));
    /// assert!(materials.find("alu").unwrap_err().expected.contains("AlMg4.5Mn"));
    /// # Ok::<(), kinetostat_cutting::CutError>(())
    /// ```
    ///
    /// # Errors
    /// A name that is not known, with the nearest ones.
    pub fn find(&self, name: &str) -> Result<&Material> {
        let wanted = bare(name);
        let named = |material: &&Material| {
            names_of(material).any(|known| bare(known) == wanted && !wanted.is_empty())
        };
        self.list.iter().find(named).ok_or_else(|| {
            let known = self.list.iter().flat_map(names_of);
            let mut near = nearest(name, known, 3);
            if near.is_empty() && !wanted.is_empty() {
                near = self.with_part(&wanted);
            }
            let shown: String = name.chars().take(60).collect();
            let found = format!("`{shown}` is not known");
            if !near.is_empty() {
                return CutError::suggesting(CutErrorKind::Material, "material", found, &near);
            }
            let all: Vec<&str> = self.list.iter().map(|m| m.name.as_str()).collect();
            let expected = format!("one of {}; or a file of your own", all.join(", "));
            CutError::new(CutErrorKind::Material, "material", found, expected)
        })
    }

    /// Up to five names of materials whose name or group has a text in it.
    fn with_part(&self, wanted: &str) -> Vec<&str> {
        let has = |material: &&Material| {
            names_of(material).any(|known| bare(known).contains(wanted))
                || bare(&format!("{:?}", material.group)).contains(wanted)
        };
        let found = self.list.iter().filter(has).take(5);
        found.map(|material| material.name.as_str()).collect()
    }

    /// All of them, in the order in which they are searched.
    pub fn iter(&self) -> impl Iterator<Item = &Material> {
        self.list.iter()
    }
}

fn names_of(material: &Material) -> impl Iterator<Item = &str> {
    let aliases = material.aliases.iter().map(String::as_str);
    std::iter::once(material.name.as_str()).chain(aliases)
}
