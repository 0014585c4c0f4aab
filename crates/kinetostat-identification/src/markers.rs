//! Places of the markers in the frames of their bodies as unknowns.

use kinetostat_model::{Parameter, ParameterKind};
use nalgebra::{DVector, Vector3};

use crate::experiment::Observation;
use crate::geometry::{AXES, MARKER};
use crate::unknown::{Form, Unknown, Unknowns};

/// Size that an error of a marker's place is compared with, m: far above those of links, so that what could be either is the marker's, and
/// the tool stays where the model has it.
pub const MARKER_ERROR: f64 = 0.1;

impl Unknowns {
    /// The same, and the places in their bodies' frames of all markers whose places were read. The place that a reading states is the
    /// nominal one, from which the fit starts; `size` (m) is what its error is compared with where readings do not tell it from one of a link, usually
    /// [`MARKER_ERROR`].
    #[must_use]
    pub fn with_markers(mut self, observations: &[Observation], size: f64) -> Self {
        let readings = observations.iter().flat_map(|o| &o.readings);
        for reading in readings.filter(|r| r.is_place()) {
            if self.markers.contains(&reading.marker) {
                continue;
            }
            let marker = self.markers.len();
            self.markers.push(reading.marker);
            for (k, (axis, at)) in AXES.iter().zip(reading.marker.at.iter()).enumerate() {
                self.list.push(Unknown {
                    parameter: Parameter {
                        path: format!("{MARKER}{}.{axis}", marker + 1),
                        value: 1e3 * at,
                        unit: "mm",
                        kind: ParameterKind::Length,
                        in_si: 1e-3,
                    },
                    form: Form::Marker(marker, k),
                    nominal: *at,
                    size,
                });
            }
        }
        self
    }

    /// Places of the markers in the frames of their bodies, m, in the order of `markers`.
    pub(crate) fn marker_places(&self, values: &DVector<f64>) -> Vec<Vector3<f64>> {
        let mut places: Vec<Vector3<f64>> = self.markers.iter().map(|m| m.at).collect();
        for (unknown, value) in self.list.iter().zip(values.iter()) {
            if let Form::Marker(marker, k) = unknown.form {
                places[marker][k] = *value;
            }
        }
        places
    }
}
