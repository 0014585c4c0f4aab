//! Quantities on a grid of places.

/// An axis of a grid.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldAxis {
    /// Name of the axis, as in `x`.
    pub name: String,
    /// Unit of the coordinates.
    pub unit: String,
    /// Places along it, rising.
    pub places: Vec<f64>,
}

/// A column of numbers, one for each place.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldColumn {
    /// Name: letters, digits and `_`.
    pub name: String,
    /// Unit of the values.
    pub unit: String,
    /// Description of the quantity.
    pub description: String,
    /// A number for each place.
    pub values: Vec<f64>,
}

/// Quantities on a grid; the first axis runs fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct Fields {
    /// Title: the subject of the data.
    pub title: String,
    /// Facts about all of it, name and text.
    pub facts: Vec<(String, String)>,
    /// x, y and z.
    pub axes: [FieldAxis; 3],
    /// Quantities.
    pub columns: Vec<FieldColumn>,
}

/// Error that prevents a file from being made.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct FieldError(pub String);

impl Fields {
    /// Number of places.
    #[must_use]
    pub fn len(&self) -> usize {
        self.axes.iter().map(|axis| axis.places.len()).product()
    }

    /// True without places.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Coordinates of all places along an axis.
    #[cfg(feature = "parquet")]
    pub(crate) fn coordinates(&self, axis: usize) -> Vec<f64> {
        let counts = self.axes.each_ref().map(|axis| axis.places.len());
        let stride: usize = counts[..axis].iter().product();
        let at = |place: usize| self.axes[axis].places[place / stride % counts[axis]];
        (0..self.len()).map(at).collect()
    }
}
