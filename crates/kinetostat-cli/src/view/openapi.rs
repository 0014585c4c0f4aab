//! The questions of the page for other programs: OpenAPI 3.1, made of the types themselves.

use schemars::generate::{SchemaGenerator, SchemaSettings};
use schemars::{JsonSchema, Schema};
use serde_json::{Map, Value, json};

use crate::shown::answer::{
    CurveOfState, CurveRequest, LobesOfState, LobesRequest, MachineAnswer, MapOfState, MapRequest,
    ModesOfState, Nothing, PathAnswer, ResponseOfState, ResponseRequest, StateAnswer, StateRequest,
    StockAtPlace, StockRequest,
};
use crate::view::asked::{StartAnswer, StartRequest};
use crate::view::dropped::OpenRequest;

/// Schema of a request or an answer.
type Made = fn(&mut SchemaGenerator) -> Schema;

/// A question: its name, what it asks for, request and answer.
struct Described(&'static str, &'static str, Made, Made);

fn asked<R: JsonSchema, A: JsonSchema>(name: &'static str, words: &'static str) -> Described {
    Described(
        name,
        words,
        SchemaGenerator::subschema_for::<R>,
        SchemaGenerator::subschema_for::<A>,
    )
}

fn all() -> Vec<Described> {
    vec![
        asked::<Nothing, Option<MachineAnswer>>("machine", "The machine; null before there is one"),
        asked::<Nothing, Option<PathAnswer>>("path", "The path of its program; null without one"),
        asked::<StateRequest, StateAnswer>("state", "The machine in a state under a load"),
        asked::<StockRequest, StockAtPlace>("stock", "What is left of the stock at a place"),
        asked::<StateRequest, ModesOfState>("modes", "Vibrations about a state"),
        asked::<CurveRequest, CurveOfState>("curve", "Equilibria while a load grows"),
        asked::<MapRequest, MapOfState>("map", "A quantity over places"),
        asked::<ResponseRequest, ResponseOfState>(
            "response",
            "Response of the tip to a vibrating force",
        ),
        asked::<LobesRequest, LobesOfState>("lobes", "Speeds and depths at which a cut chatters"),
        asked::<StartRequest, StartAnswer>("start", "The questions of `kinetostat start`"),
        asked::<OpenRequest, ()>("open", "Shows the job, or the model, of some files"),
    ]
}

/// The description of the server.
pub(super) fn openapi() -> Value {
    let settings = SchemaSettings::draft2020_12();
    let settings = settings.with(|s| s.definitions_path = "/components/schemas".into());
    let mut generator = settings.into_generator();
    let content = |schema: Value| json!({ "application/json": { "schema": schema } });
    let refusal = json!({
        "type": "object", "required": ["error"],
        "properties": { "error": {
            "type": "object", "required": ["code", "message"],
            "properties": { "code": { "type": "string" }, "message": { "type": "string" } },
        } },
    });
    let refused =
        |words: &str| json!({ "description": words, "content": content(refusal.clone()) });
    let mut paths = Map::new();
    for Described(name, words, request, answer) in all() {
        let [request, answer] = [request, answer].map(|made| made(&mut generator).to_value());
        let question = json!({ "post": {
            "operationId": name,
            "summary": words,
            "requestBody": { "required": true, "content": content(request) },
            "responses": {
                "200": { "description": words, "content": content(answer) },
                "404": refused("There is no machine yet"),
                "413": refused("A request that is too long"),
                "415": refused("A request that is no JSON"),
                "422": refused("A question that cannot be answered, with its reason"),
            },
        } });
        paths.insert(format!("/api/{name}"), question);
    }
    json!({
        "openapi": "3.1.0",
        "info": { "title": "kinetostat view", "version": env!("CARGO_PKG_VERSION") },
        "paths": paths,
        "components": { "schemas": generator.take_definitions(true) },
    })
}
