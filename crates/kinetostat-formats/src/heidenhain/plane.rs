//! Planes of circles and polar coordinates.

use nalgebra::{Vector2, Vector3};

/// A plane by the number of the axis across it: Y and Z, Z and X, or X and Y. Angles count from the first of its axes to the second, and
/// DR+ turns so, too: HEIDENHAIN, TNC 640, user's manual, Klartext programming, "Polar coordinates: zero point, pole and angle
/// reference axis", table of planes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Plane(pub usize);

/// Plane across the tool axis Z.
pub(crate) const XY: Plane = Plane(2);

impl Default for Plane {
    fn default() -> Self {
        XY
    }
}

impl Plane {
    /// The numbers of its axes.
    pub(crate) fn axes(self) -> [usize; 2] {
        [(self.0 + 1) % 3, (self.0 + 2) % 3]
    }

    /// A place in it.
    pub(crate) fn flat(self, place: &Vector3<f64>) -> Vector2<f64> {
        let [u, v] = self.axes();
        Vector2::new(place[u], place[v])
    }

    /// Projects a position whose third coordinate may be unknown.
    pub(crate) fn known(self, place: [Option<f64>; 3]) -> Option<Vector2<f64>> {
        let [u, v] = self.axes();
        Some(Vector2::new(place[u]?, place[v]?))
    }

    /// A place of its two coordinates and that across.
    pub(crate) fn place(self, flat: Vector2<f64>, across: f64) -> Vector3<f64> {
        let [u, v] = self.axes();
        let mut place = Vector3::zeros();
        (place[u], place[v], place[self.0]) = (flat.x, flat.y, across);
        place
    }

    /// The direction across.
    pub(crate) fn across(self) -> Vector3<f64> {
        self.place(Vector2::zeros(), 1.0)
    }
}
