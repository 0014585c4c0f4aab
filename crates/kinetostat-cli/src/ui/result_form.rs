//! Published form of a result: its name and its JSON schema.

use schemars::{JsonSchema, Schema, SchemaGenerator};

/// One kind of JSON result of a command. A command with several ways of being called has one for each.
#[derive(Clone, Copy)]
pub(crate) struct ResultForm {
    /// Name for people: `stiffness at one place`.
    pub(crate) title: &'static str,
    /// Adds the type and what it contains to the definitions, and returns the reference to it.
    pub(crate) schema: fn(&mut SchemaGenerator) -> Schema,
}

impl ResultForm {
    pub(crate) const fn of<T: JsonSchema>(title: &'static str) -> Self {
        Self {
            title,
            schema: SchemaGenerator::subschema_for::<T>,
        }
    }
}
