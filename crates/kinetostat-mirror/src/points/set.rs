//! Points where the tool was measured, or those of the path of a second program.

use kinetostat_program::{NominalPath, Path};
use nalgebra::Vector3;
use sha2::{Digest, Sha256};

use crate::error::MirrorError;

/// Largest coordinate in a workshop, mm: a larger number is in another unit than its column says.
const FARTHEST_MM: f64 = 1e6;

/// Weights beyond this and below its inverse are no measurement's, and sums of them lose all others: standard deviations from
/// 1e-12 mm to 1e12 mm.
const MOST_WEIGHT: f64 = 1e24;

/// The fewest from which a rigid motion and a scatter can be told.
const FEWEST: usize = 3;

/// Measured point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredPoint {
    /// Row of the measurement, from 1; the header is not counted.
    pub row: usize,
    /// Line of the file, from 1; the row itself where there is no file.
    pub line: usize,
    /// Measured position, mm, in the frame of the measurement.
    pub position_mm: Vector3<f64>,
    /// Weight in every mean, `1 / sigma^2` if standard deviations are stated.
    pub weight: f64,
    /// Line of the program on which the tool was, where the measurement says so.
    pub program_line: Option<usize>,
}

/// The points of one measurement.
///
/// ```
/// use kinetostat_mirror::MeasuredPoints;
///
/// let text = "x_mm,y_mm,z_m,sigma_um\n0,0,0,2\n10,0,0,2\n20,0,0.001,4\n";
/// let points = MeasuredPoints::read("trial1.csv", text)?;
/// assert_eq!(points.points().len(), 3);
/// assert_eq!(points.points()[2].position_mm.z, 1.0);
/// assert_eq!(points.points()[2].weight / points.points()[0].weight, 0.25);
/// # Ok::<(), kinetostat_mirror::MirrorError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredPoints {
    points: Vec<MeasuredPoint>,
    known_to_mm: f64,
}

impl MeasuredPoints {
    /// Points in the order in which they were measured.
    ///
    /// ```
    /// use kinetostat_mirror::MeasuredPoints;
    /// use nalgebra::Vector3;
    ///
    /// let corners = [[0.0, 0.0], [50.0, 0.0], [50.0, 30.0]].map(|[x, y]| Vector3::new(x, y, 0.0));
    /// assert!(MeasuredPoints::at(&corners).is_ok());
    /// let why = MeasuredPoints::at(&corners[..2]).unwrap_err().to_string();
    /// assert!(why.starts_with("2 measured points"), "{why}");
    /// ```
    ///
    /// # Errors
    /// Fewer than three, positions that are no numbers or beyond 1 km.
    pub fn at(positions_mm: &[Vector3<f64>]) -> Result<Self, MirrorError> {
        let points = positions_mm.iter().zip(1..);
        Self::new(
            points
                .map(|(position_mm, row)| MeasuredPoint {
                    row,
                    line: row,
                    position_mm: *position_mm,
                    weight: 1.0,
                    program_line: None,
                })
                .collect(),
        )
    }

    /// Points with weights and lines of the program.
    ///
    /// # Errors
    /// As [`MeasuredPoints::at`]; weights that are not positive, or of no measurement.
    pub fn new(points: Vec<MeasuredPoint>) -> Result<Self, MirrorError> {
        if points.len() < FEWEST {
            return Err(MirrorError::new(format!(
                "{} measured points; {FEWEST} at least are needed, and some on each length over which deviations are smoothed",
                points.len()
            )));
        }
        for point in &points {
            possible(point)?;
        }
        Ok(Self {
            points,
            known_to_mm: 0.0,
        })
    }

    /// Differences of deviations from point to point say nothing below this standard deviation, mm: the repeatability of the
    /// measurement, the digits of its file (which [`MeasuredPoints::read`] takes itself), the tolerance within which the program that
    /// was measured follows its correction. The largest of several is taken. No point is an outlier within six of them.
    ///
    /// ```
    /// use kinetostat_mirror::MeasuredPoints;
    ///
    /// let points = MeasuredPoints::read("trial1.csv", "x_mm,y_mm,z_mm\n0,0,0.003\n1,0,0\n2,0,0\n")?;
    /// assert!((points.known_to_mm() - 0.001 / 12.0_f64.sqrt()).abs() < 1e-12);
    /// assert_eq!(points.known_to(0.002).known_to(5e-4).known_to_mm(), 0.002);
    /// # Ok::<(), kinetostat_mirror::MirrorError>(())
    /// ```
    #[must_use]
    pub fn known_to(mut self, deviation_mm: f64) -> Self {
        if deviation_mm > self.known_to_mm {
            self.known_to_mm = deviation_mm;
        }
        self
    }

    /// The largest standard deviation that was stated, mm; 0 without one.
    #[must_use]
    pub fn known_to_mm(&self) -> f64 {
        self.known_to_mm
    }

    /// The points.
    #[must_use]
    pub fn points(&self) -> &[MeasuredPoint] {
        &self.points
    }
}

/// A place in a workshop with a weight.
pub(crate) fn possible(point: &MeasuredPoint) -> Result<(), MirrorError> {
    let at = &point.position_mm;
    if !at.iter().all(|x| x.abs() <= FARTHEST_MM) {
        return Err(MirrorError::new(format!(
            "row {}: the point ({}, {}, {}) mm is no place in a workshop: leave the row out, or correct the unit in the header",
            point.row, at.x, at.y, at.z
        )));
    }
    match (1.0 / MOST_WEIGHT..=MOST_WEIGHT).contains(&point.weight) {
        true => Ok(()),
        false => Err(MirrorError::new(format!(
            "row {}: the weight (or 1 / sigma^2, sigma in mm) is {:e}; expected a number from {:e} to {MOST_WEIGHT:e}: leave out a row that is not to count",
            point.row,
            point.weight,
            1.0 / MOST_WEIGHT
        ))),
    }
}

/// Units per mm to which points are rounded: no measurement is finer than a nanometre, and units of a file round
/// below it.
const IN_MM: f64 = 1e6;

impl MeasuredPoints {
    /// SHA-256 of the places in whole nanometres, sorted: the same for two files of the same points, whatever their order,
    /// spacing, remarks and units.
    ///
    /// ```
    /// use kinetostat_mirror::MeasuredPoints;
    ///
    /// let hash = |text| MeasuredPoints::read("trial.csv", text).map(|points| points.sha256());
    /// let one = hash("x_mm,y_mm,z_mm\n0,0,0\n1,0,0\n2,0.5,0\n")?;
    /// let same = hash("# again\nz_mm; y_um; x_m\n\n 0; 500; 0.002\n-0; 0; 0.001\n0.0; 0; 0\n")?;
    /// let other = hash("x_mm,y_mm,z_mm\n0,0,0\n1,0,0\n2,0.501,0\n")?;
    /// assert!(one == same && one != other);
    /// # Ok::<(), kinetostat_mirror::MirrorError>(())
    /// ```
    #[must_use]
    pub fn sha256(&self) -> String {
        let places = self.points().iter().map(|point| {
            let whole = point.position_mm.map(|mm| (mm * IN_MM).round() as i64);
            [whole.x, whole.y, whole.z]
        });
        let mut places: Vec<[i64; 3]> = places.collect();
        places.sort_unstable();
        let mut hash = Sha256::new();
        for axis in places.iter().flatten() {
            hash.update(axis.to_le_bytes());
        }
        let hash = hash.finalize();
        hash.iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

/// Maximum number of points: more are of no use and fill the memory.
const MOST: f64 = 1e7;

impl MeasuredPoints {
    /// Points along the feed moves of a second program: one at each end of a move, and between them no farther apart than the
    /// spacing.
    ///
    /// ```
    /// use kinetostat_mirror::MeasuredPoints;
    /// use kinetostat_program::{Program, ReadOptions, interpret};
    ///
    /// let program = Program::read("G21 G90\nG0 X0 Y0 Z0\nG1 X10 F300\nG1 Y1\n")?;
    /// let path = interpret(&program, &ReadOptions::default())?;
    /// let points = MeasuredPoints::along(&path, 5.0)?;
    /// assert_eq!(points.points().len(), 4);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A program without a feed move that has a length; a spacing that is not positive, or of more than 1e7 points.
    pub fn along(path: &Path, spacing_mm: f64) -> Result<Self, MirrorError> {
        let nominal = NominalPath::new(path)?;
        let wanted = nominal.length_mm() / spacing_mm;
        if !(spacing_mm > 0.0 && wanted <= MOST) {
            return Err(MirrorError::new(format!(
                "a point every {spacing_mm} mm along {} mm; expected a spacing above 0 and at most {MOST} points",
                nominal.length_mm()
            )));
        }
        let mut positions = Vec::new();
        let mut last_pass = None;
        for piece in nominal.pieces() {
            if last_pass.replace(piece.pass) != Some(piece.pass) {
                positions.push(nominal.motion(piece).point(0.0));
            }
            let parts = (piece.length_mm / spacing_mm).ceil().max(1.0) as usize;
            let shares = (1..=parts).map(|part| part as f64 / parts as f64);
            positions.extend(shares.map(|share| nominal.motion(piece).point(share)));
        }
        Self::at(&positions)
    }
}
