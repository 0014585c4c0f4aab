//! Every public method of the core's front door is called in an example that runs.
//!
//! The front door is what the root of the core re-exports; examples are the code blocks of doc comments and of the
//! README, hidden lines included. Called is `Type::function(..)` or, of what takes a value of the type, also `.method(..)`:
//! of which type the value before a dot is, is not looked into. What a macro other than `setters!` writes is not seen.

use std::collections::BTreeSet;
use std::path::Path;

use quote::ToTokens;
use syn::visit::Visit;

/// What is read from the sources.
#[derive(Default)]
struct Core {
    /// Type, function, and whether it takes a value of the type.
    methods: BTreeSet<(String, String, bool)>,
    examples: String,
    /// Inside a code block, and whether that is Rust and runs.
    inside: bool,
    runs: bool,
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    let words = text.split(|c: char| !c.is_alphanumeric() && c != '_');
    words.filter(|word| !word.is_empty())
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn is_hidden(attribute: &syn::Attribute) -> bool {
    attribute.to_token_stream().to_string() == "# [doc (hidden)]"
}

impl Core {
    fn take_folder(&mut self, folder: &Path) {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                self.take_folder(&path);
            } else {
                self.visit_file(&syn::parse_file(&read(&path)).expect("a source"));
            }
        }
    }

    fn take_doc(&mut self, text: &str) {
        for line in text.lines() {
            if let Some(language) = line.trim().strip_prefix("```") {
                self.inside = !self.inside;
                self.runs = self.inside && ["", "rust"].contains(&language);
            } else if self.runs {
                self.examples += &format!("{line}\n");
            }
        }
    }

    fn call(&self, (of, method, takes_self): &(String, String, bool)) -> bool {
        let by_value = takes_self.then(|| format!(".{method}"));
        let calls = [Some(format!("{of}::{method}")), by_value];
        // `Chain::new(` is not a part of `SerialChain::new(`.
        let whole = |before: &str| !before.ends_with(|c: char| c.is_alphanumeric() || c == '_');
        let has = |text: String| {
            let mut found = self.examples.match_indices(&text);
            found.any(|(at, _)| text.starts_with('.') || whole(&self.examples[..at]))
        };
        (calls.iter().flatten()).any(|call| has(format!("{call}(")) || has(format!("{call}::<")))
    }
}

impl<'a> Visit<'a> for Core {
    fn visit_attribute(&mut self, attribute: &'a syn::Attribute) {
        if let syn::Meta::NameValue(of) = &attribute.meta
            && let (true, syn::Expr::Lit(literal)) = (of.path.is_ident("doc"), &of.value)
            && let syn::Lit::Str(text) = &literal.lit
        {
            self.take_doc(&text.value());
        }
    }

    fn visit_item_impl(&mut self, item: &'a syn::ItemImpl) {
        let of = item.self_ty.to_token_stream().to_string();
        for method in &item.items {
            if let syn::ImplItem::Fn(method) = method
                && matches!(method.vis, syn::Visibility::Public(_))
                && !method.attrs.iter().any(is_hidden)
            {
                let of = words(&of).next().unwrap_or_default().to_owned();
                let takes_self = method.sig.receiver().is_some();
                (self.methods).insert((of, method.sig.ident.to_string(), takes_self));
            }
        }
        syn::visit::visit_item_impl(self, item);
    }

    /// Setters that a macro writes: `setters!(Settings { with_closure: closure: f64, .. })`.
    fn visit_macro(&mut self, item: &'a syn::Macro) {
        let text = item.tokens.to_string();
        let of = words(&text).next().unwrap_or_default();
        let setters = words(&text).filter(|word| word.starts_with("with_"));
        (self.methods).extend(setters.map(|setter| (of.to_owned(), setter.to_owned(), true)));
    }
}

#[test]
fn every_method_of_the_front_door_is_called_in_an_example() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/kinetostat");
    let mut core = Core::default();
    core.take_folder(&root.join("src"));
    core.take_doc(&read(&root.join("README.md")));
    let lib = read(&root.join("src/lib.rs"));
    let exports = lib.split("\npub use ").skip(1);
    let names = exports.flat_map(|text| words(text.split(';').next().unwrap_or_default()));
    let front_door: BTreeSet<&str> = names.collect();
    let on_front = |(of, ..): &&(String, String, bool)| front_door.contains(of.as_str());
    let all: Vec<_> = core.methods.iter().filter(on_front).collect();
    assert!(all.len() > 150, "most methods were not found");
    let without_value = all.iter().filter(|(.., takes_self)| !takes_self).count();
    assert!(without_value > 30, "most functions were not found");
    let missing = all.iter().filter(|method| !core.call(method));
    let names = missing.map(|(of, method, _)| format!("{of}::{method}\n"));
    let list: String = names.collect();
    assert!(list.is_empty(), "no example calls\n{list}");
}
