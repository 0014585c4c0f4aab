//! Elastostatics of chains and mechanisms by virtual joint modelling.
