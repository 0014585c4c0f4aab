//! Conditions under which the closed forms of a stiffness hold.

/// Reason why a form has no answer here.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Inapplicable {
    /// `J_theta k J_theta^T` is singular: the springs alone do not move the end in all six
    /// directions [R remark 1]. Carries how many they move.
    SpringsDoNotReach(usize),
    /// `J_q^T K J_q` is singular: these passive joints are redundant [R remark 2].
    RedundantPassiveJoints(Vec<String>),
    /// `K_theta - H_thetatheta` is singular: the load takes a spring's hold, as if nothing else
    /// held it.
    SpringsAreSpent,
    /// The last bracket of [R 4.29] is singular: the held chain has a neutral motion of these
    /// passive joints (redundancy, or a critical load).
    PassiveJointsUndecided(Vec<String>),
    /// The order must name each passive joint at most once; carries how many there are.
    NotAnOrder(usize),
    /// The form is that of the unloaded chain [R 3.10, 3.11], and this one is loaded.
    Loaded,
}

/// Answer of a form that does not always apply; `Err` says why it does not.
pub type Applied<T> = std::result::Result<T, Inapplicable>;
