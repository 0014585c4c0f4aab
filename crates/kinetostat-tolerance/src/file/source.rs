//! Sources of uncertain numbers.

/// Source of an uncertain number.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// A number of the model file, by its path.
    Parameter(String),
    /// A component of the load on the tool: force (N), then moment (N m).
    Load(usize),
    /// A factor on the whole load, 1 in the drawing: how far all cutting coefficients may be off together.
    LoadFactor,
    /// A factor on one part of the force of the cut, 1 in the drawing, as an index into [`CUTTING_PARTS`]: how far its coefficients
    /// may be off.
    CuttingPart(usize),
}

impl Source {
    /// Values of the numbers that belong to the model file.
    pub(crate) fn of_model(sources: &[Self], values: &[f64]) -> Vec<f64> {
        let each = sources.iter().zip(values);
        let own = each.filter(|(source, _)| matches!(source, Self::Parameter(_)));
        own.map(|(_, value)| *value).collect()
    }
}

/// Parts of the force of the cut, each with coefficients of its own: against the way of a tooth, against its normal, along its edge; of a
/// stated milling force along the feed, across it, along the tool.
pub const CUTTING_PARTS: [&str; 3] = ["tangential", "radial", "axial"];
