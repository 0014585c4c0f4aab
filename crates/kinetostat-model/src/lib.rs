//! Model files of robots: TOML with units in the keys, presets, JSON Schema.
