//! The path of a second program as points.

use kinetostat_program::Path;

use crate::error::MirrorError;
use crate::points::set::MeasuredPoints;
use kinetostat_program::NominalPath;

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
