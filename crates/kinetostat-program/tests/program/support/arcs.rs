//! G2 and G3.

use super::WORK;
use super::generator::Generator;
use super::truth::Truth;

impl Generator<'_> {
    #[allow(clippy::too_many_arguments)]
    pub(super) fn arc(
        &mut self,
        clockwise: bool,
        radius: f64,
        angle: f64,
        sweep: f64,
        rise: Option<f64>,
        by_radius: bool,
        full: bool,
        speed: Option<f64>,
    ) {
        let axes = [[0, 1, 2], [2, 0, 1], [1, 2, 0]][self.plane];
        let by_radius = by_radius && !full;
        // The centre of an arc by radius is ill defined near half and whole turns.
        let sweep = if by_radius && (2.6..3.7).contains(&sweep) {
            2.0
        } else {
            sweep.min(5.6)
        };
        let start = self.place;
        let mut words = Vec::new();
        self.motion_word(if clockwise { 2 } else { 3 }, &mut words);
        let mut centre = [
            start[axes[0]] - radius * angle.cos(),
            start[axes[1]] - radius * angle.sin(),
        ];
        let mut centre_words = Vec::new();
        for index in 0..2 {
            let axis = axes[index];
            let letter = ["I", "J", "K"][axis];
            let origin = if self.absolute_centre {
                WORK[self.work][axis] + self.here[axis]
            } else {
                start[axis]
            };
            let (text, value) = self.number((centre[index] - origin) / self.scale());
            centre_words.push(format!("{letter}{text}"));
            if !by_radius {
                centre[index] = origin + value * self.scale();
            }
        }
        let signed = if clockwise { -sweep } else { sweep };
        let turned = |index: usize| {
            let (du, dv) = (start[axes[0]] - centre[0], start[axes[1]] - centre[1]);
            let (sine, cosine) = signed.sin_cos();
            centre[index]
                + if index == 0 {
                    du * cosine - dv * sine
                } else {
                    du * sine + dv * cosine
                }
        };
        let mut end = start;
        if !full {
            for index in 0..2 {
                let (word, reached) = self.coordinate(axes[index], turned(index));
                words.push(word);
                end[axes[index]] = reached;
            }
        }
        if let Some(rise) = rise {
            let (word, reached) = self.coordinate(axes[2], start[axes[2]] + rise);
            words.push(word);
            end[axes[2]] = reached;
        }
        if by_radius {
            let (text, _) = self.number(radius / self.scale());
            let sign = if sweep > std::f64::consts::PI {
                "-"
            } else {
                ""
            };
            words.push(format!("R{sign}{text}"));
        } else {
            words.extend(centre_words);
        }
        let sweep = match (full, clockwise) {
            (true, true) => -std::f64::consts::TAU,
            (true, false) => std::f64::consts::TAU,
            (false, _) => signed,
        };
        self.speed_word(speed, radius * sweep.abs(), &mut words);
        self.place = end;
        self.fact([true; 3], [true; 3], false);
        self.truths.push(Truth::Arc {
            axes,
            centre,
            start,
            end,
            sweep,
        });
        self.push(&words);
    }
}
