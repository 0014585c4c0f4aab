//! Effort of a search.

/// Effort of a search.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Placements that fill the space, of each fixture; by the number of variables without it.
    pub samples: Option<usize>,
    /// The best ones apart from each other that are refined.
    pub starts: usize,
    /// Next best placements that are listed.
    pub listed: usize,
    /// Maximum number of places of the program; a longer one is thinned.
    pub most_places: usize,
    /// True if slices are solved for pictures.
    pub maps: bool,
}

impl Default for Effort {
    fn default() -> Self {
        Self {
            samples: None,
            starts: 6,
            listed: 10,
            most_places: 100_000,
            maps: true,
        }
    }
}
