//! G-code programs: read without loss, corrected by any field of corrections, written and checked.
