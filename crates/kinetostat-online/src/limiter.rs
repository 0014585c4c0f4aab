//! Rate and acceleration of the correction: a follower of a target that may jump.
//!
//! Each cycle the follower wants the velocity towards its target from which it can still stop there,
//!
//! ```text
//! v = min(v_max, d / T, a (sqrt(T^2/4 + 2 d / a) - T/2)):   v^2 / 2a + v T / 2 = d
//! ```
//!
//! and changes its velocity towards that by at most `a T`. Both velocities lie in the ball of `v_max`, and so does the
//! straight line between them: no step is longer than `v_max T`, whatever the target does. Where `d <= a T^2` it lands on the target exactly.

use nalgebra::Vector3;

/// Largest speed and acceleration, by seconds, of a part of the correction (m or rad).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rate {
    pub speed: f64,
    pub acceleration: f64,
}

/// Position (m or rad) and velocity of a follower.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Follower {
    pub at: Vector3<f64>,
    velocity: Vector3<f64>,
}

impl Follower {
    /// Goes towards a target for one period; true if the rate or the acceleration held it back.
    pub(crate) fn follow(&mut self, target: &Vector3<f64>, rate: &Rate, period: f64) -> bool {
        let way = target - self.at;
        let distance = way.norm();
        let a = rate.acceleration;
        let braking = a * ((0.25 * period * period + 2.0 * distance / a).sqrt() - 0.5 * period);
        let speed = rate.speed.min(distance / period).min(braking);
        let wanted = match distance > 0.0 {
            true => way * (speed / distance),
            false => Vector3::zeros(),
        };
        let change = wanted - self.velocity;
        let allowed = a * period;
        let bound = change.norm() > allowed * (1.0 + 1e-9);
        if bound {
            self.velocity += change * (allowed / change.norm());
        } else {
            self.velocity = wanted;
        }
        let lands = !bound && speed == distance / period;
        self.at = match lands {
            true => *target,
            false => self.at + self.velocity * period,
        };
        !lands
    }

    /// Goes towards a target without regard to acceleration, for the steps of a probe; the speed is limited.
    pub(crate) fn step_to(&mut self, target: &Vector3<f64>, rate: &Rate, period: f64) {
        let way = target - self.at;
        let most = rate.speed * period;
        self.at = match way.norm() > most {
            true => self.at + way * (most / way.norm()),
            false => *target,
        };
        self.velocity = Vector3::zeros();
    }

    /// True if it rests at zero.
    pub(crate) fn is_at_rest(&self) -> bool {
        self.at == Vector3::zeros() && self.velocity == Vector3::zeros()
    }
}
