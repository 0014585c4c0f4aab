//! Which file uses which: no import cycle in any crate, and in the core no room uses one above it.
//!
//! The arrows are read from the sources: `use` lines and paths, `crate::` in macros too; re-exports are followed to where
//! the item is defined. A call of a method draws an arrow to the file that adds it to a type, where no other file of the
//! crate, no crate of ours on which it depends and no library ([`OTHERS`]) has a method of this name. Test modules are
//! left out. What it does not see: calls of methods inside macros, `super::` there, `Type::method(..)` where an `impl`
//! stands apart from its type, and methods whose name two files of the crate share.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use syn::visit::Visit;

/// Rooms of the core, each of which may use those before it.
const ROOMS: [&str; 15] = [
    "parallel",
    "number",
    "spatial",
    "error",
    "settings",
    "linalg",
    "model",
    "chain",
    "machine",
    "continuation",
    "equilibrium",
    "compensation",
    "batch",
    "reference",
    "internal",
];

/// Files that belong together although each uses the other, with the reason.
const TOGETHER: [(&str, &[&str], &str); 1] = [(
    "kinetostat-formats",
    &[
        "interpreter/control",
        "interpreter/passing",
        "interpreter/storage",
    ],
    "a function in an expression runs statements, and statements evaluate expressions: one run",
)];

/// Methods of libraries that one of our types has too: whose a call is, only types tell.
const OTHERS: [&str; 64] = [
    "abs",
    "all",
    "any",
    "chain",
    "clear",
    "clone",
    "close",
    "cmp",
    "collect",
    "column",
    "columns",
    "complete",
    "contains",
    "count",
    "dot",
    "element",
    "end",
    "eq",
    "error",
    "extend",
    "file",
    "fill",
    "find",
    "first",
    "fold",
    "get",
    "insert",
    "is_empty",
    "is_finite",
    "iter",
    "join",
    "key",
    "keys",
    "last",
    "len",
    "map",
    "max",
    "max_by",
    "min",
    "min_by",
    "name",
    "next",
    "norm",
    "path",
    "platform",
    "position",
    "product",
    "push",
    "remove",
    "row",
    "rows",
    "set_column",
    "set_row",
    "span",
    "split",
    "sqrt",
    "start",
    "step",
    "sum",
    "take",
    "transpose",
    "value",
    "values",
    "zip",
];

/// A module by its path in the crate; the root is empty.
type Module = Vec<String>;

/// The sources of one crate.
#[derive(Default)]
struct Crate {
    files: BTreeMap<Module, syn::File>,
    /// Module and name to the path that it re-exports.
    exports: BTreeMap<(Module, String), Vec<String>>,
}

fn is_test(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        let text = quote::quote!(#attribute).to_string();
        attribute.path().is_ident("cfg") && text.contains("test") && !text.contains("not")
    })
}

impl Crate {
    fn read(root: &Path) -> Self {
        let mut all = Self::default();
        let entry = ["lib.rs", "main.rs"].map(|name| root.join(name));
        for file in entry.iter().filter(|file| file.exists()) {
            all.take(Module::new(), file);
        }
        assert!(!all.files.is_empty(), "no sources in {}", root.display());
        all
    }

    /// Reads a file and the modules that it declares; those of tests are left out.
    fn take(&mut self, module: Module, path: &Path) {
        let text = std::fs::read_to_string(path)
            .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let file =
            syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let own = path
            .file_stem()
            .map(|stem| stem.to_string_lossy().into_owned());
        let folder: PathBuf = match own.as_deref() {
            Some("lib" | "main" | "mod") | None => path.parent().expect("a folder").into(),
            Some(stem) => path.parent().expect("a folder").join(stem),
        };
        for item in &file.items {
            match item {
                syn::Item::Mod(child) if child.content.is_none() && !is_test(&child.attrs) => {
                    let name = child.ident.to_string();
                    let inner = [format!("{name}.rs"), format!("{name}/mod.rs")];
                    let found = inner
                        .iter()
                        .map(|name| folder.join(name))
                        .find(|p| p.exists());
                    let Some(found) = found else { continue };
                    let child = module.iter().cloned().chain([name]).collect();
                    self.take(child, &found);
                }
                syn::Item::Use(item) if !matches!(item.vis, syn::Visibility::Inherited) => {
                    for (path, name) in flat(&item.tree) {
                        self.exports.insert((module.clone(), name), path);
                    }
                }
                _ => {}
            }
        }
        self.files.insert(module, file);
    }

    /// The module in which what a path names is defined; `None` for other crates.
    fn defined_in(&self, at: &Module, path: &[String], depth: usize) -> Option<Module> {
        let mut rest = path.iter().peekable();
        let mut module = match path.first()?.as_str() {
            "crate" => {
                rest.next();
                Module::new()
            }
            "self" => {
                rest.next();
                at.clone()
            }
            "super" => {
                let mut module = at.clone();
                while rest.next_if(|part| *part == "super").is_some() {
                    module.pop();
                }
                module
            }
            first => {
                let child: Module = at.iter().cloned().chain([first.to_owned()]).collect();
                self.files.contains_key(&child).then(|| at.clone())?
            }
        };
        while let Some(part) = rest.peek() {
            let child: Module = module.iter().chain([*part]).cloned().collect();
            if !self.files.contains_key(&child) {
                break;
            }
            module = child;
            rest.next();
        }
        let exported = rest.peek().and_then(|name| {
            let target = self.exports.get(&(module.clone(), (*name).clone()))?;
            (depth < 8).then(|| self.defined_in(&module, target, depth + 1))?
        });
        exported.or(Some(module))
    }

    /// Where the methods are that types have of this crate; `None` for one of a trait, and where several files have one
    /// of the name.
    fn methods(&self) -> BTreeMap<String, Option<&Module>> {
        let mut found = BTreeMap::new();
        for (module, file) in &self.files {
            let mut methods = Methods::default();
            methods.visit_file(file);
            for (name, of_trait) in methods.0 {
                let own = (!of_trait).then_some(module);
                let first = found.entry(name).or_insert(own);
                if *first != own {
                    *first = None;
                }
            }
        }
        found
    }

    /// What every module uses of which other module; methods named as one of the others may be theirs.
    fn arrows(
        &self,
        others: &BTreeSet<String>,
    ) -> BTreeMap<Module, BTreeMap<Module, BTreeSet<String>>> {
        let mut arrows = BTreeMap::<_, BTreeMap<_, BTreeSet<_>>>::new();
        let methods = self.methods();
        // The root only declares and re-exports.
        for (module, file) in self.files.iter().filter(|(module, _)| !module.is_empty()) {
            let mut paths = Paths::default();
            paths.visit_file(file);
            let named = (paths.named.iter())
                .filter_map(|path| Some((self.defined_in(module, path, 0)?, path.join("::"))));
            let called = (paths.called.iter())
                .filter(|name| !others.contains(*name))
                .filter_map(|name| Some(((*methods.get(name)?)?.clone(), format!(".{name}()"))));
            for (used, name) in named.chain(called).filter(|(used, _)| used != module) {
                let names = arrows.entry(module.clone()).or_default().entry(used);
                names.or_default().insert(name);
            }
        }
        arrows
    }
}

/// Paths and names that a tree of `use` brings in.
fn flat(tree: &syn::UseTree) -> Vec<(Vec<String>, String)> {
    match tree {
        syn::UseTree::Path(path) => {
            let below = flat(&path.tree).into_iter();
            let with = |(rest, name): (Vec<String>, String)| {
                let whole = std::iter::once(path.ident.to_string()).chain(rest);
                (whole.collect(), name)
            };
            below.map(with).collect()
        }
        syn::UseTree::Name(name) => vec![(vec![name.ident.to_string()], name.ident.to_string())],
        syn::UseTree::Rename(name) => {
            vec![(vec![name.ident.to_string()], name.rename.to_string())]
        }
        syn::UseTree::Glob(_) => vec![(Vec::new(), "*".into())],
        syn::UseTree::Group(group) => group.items.iter().flat_map(flat).collect(),
    }
}

/// Methods of a file, and whether a trait asks for them.
#[derive(Default)]
struct Methods(Vec<(String, bool)>);

impl<'a> Visit<'a> for Methods {
    fn visit_item_mod(&mut self, item: &'a syn::ItemMod) {
        if !is_test(&item.attrs) {
            syn::visit::visit_item_mod(self, item);
        }
    }

    fn visit_item_trait(&mut self, item: &'a syn::ItemTrait) {
        for part in &item.items {
            if let syn::TraitItem::Fn(method) = part {
                self.0.push((method.sig.ident.to_string(), true));
            }
        }
    }

    fn visit_item_impl(&mut self, item: &'a syn::ItemImpl) {
        for part in &item.items {
            if let syn::ImplItem::Fn(method) = part {
                let own = method.sig.ident.to_string();
                self.0.push((own, item.trait_.is_some()));
            }
        }
    }
}

/// All paths of a file, and the names of the methods that it calls.
#[derive(Default)]
struct Paths {
    named: Vec<Vec<String>>,
    called: BTreeSet<String>,
}

impl<'a> Visit<'a> for Paths {
    fn visit_item_mod(&mut self, item: &'a syn::ItemMod) {
        if !is_test(&item.attrs) {
            syn::visit::visit_item_mod(self, item);
        }
    }

    fn visit_item_use(&mut self, item: &'a syn::ItemUse) {
        let all = flat(&item.tree).into_iter().map(|(path, _)| path);
        self.named.extend(all);
    }

    fn visit_path(&mut self, path: &'a syn::Path) {
        if path.segments.len() > 1 {
            let parts = path.segments.iter().map(|part| part.ident.to_string());
            self.named.push(parts.collect());
        }
        syn::visit::visit_path(self, path);
    }

    fn visit_expr_method_call(&mut self, call: &'a syn::ExprMethodCall) {
        self.called.insert(call.method.to_string());
        syn::visit::visit_expr_method_call(self, call);
    }

    fn visit_macro(&mut self, item: &'a syn::Macro) {
        let text = item.tokens.to_string().replace(' ', "");
        for start in text.match_indices("crate::").map(|(at, _)| at) {
            let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
            let path: String = text[start..].chars().take_while(|c| is_part(*c)).collect();
            let parts = path.split("::").filter(|part| !part.is_empty());
            self.named.push(parts.map(str::to_owned).collect());
        }
    }
}

/// A way around from a module back to itself, if there is one.
fn cycle(arrows: &BTreeMap<String, BTreeSet<String>>) -> Option<Vec<String>> {
    fn visit(
        at: &str,
        arrows: &BTreeMap<String, BTreeSet<String>>,
        path: &mut Vec<String>,
        done: &mut BTreeSet<String>,
    ) -> Option<Vec<String>> {
        if let Some(first) = path.iter().position(|known| known == at) {
            return Some(path[first..].to_vec());
        }
        if done.contains(at) {
            return None;
        }
        path.push(at.to_owned());
        let next = arrows.get(at).into_iter().flatten();
        let found = next
            .into_iter()
            .find_map(|to| visit(to, arrows, path, done));
        path.pop();
        done.insert(at.to_owned());
        found
    }
    let mut done = BTreeSet::new();
    let starts = arrows.keys();
    starts
        .into_iter()
        .find_map(|at| visit(at, arrows, &mut Vec::new(), &mut done))
}

/// Folders of crates.
const FOLDERS: [&str; 2] = [
    concat!(env!("CARGO_MANIFEST_DIR"), "/../crates"),
    concat!(env!("CARGO_MANIFEST_DIR"), "/../validation"),
];

fn crates() -> Vec<(String, Crate)> {
    let mut found: Vec<_> = (FOLDERS.iter())
        .flat_map(|folder| std::fs::read_dir(folder).expect("a folder of crates"))
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.join("src").exists())
        .collect();
    found.sort();
    assert!(found.len() >= 10, "found {} crates only", found.len());
    let named = |path: &PathBuf| {
        path.file_name()
            .expect("a name")
            .to_string_lossy()
            .into_owned()
    };
    found
        .iter()
        .map(|path| (named(path), Crate::read(&path.join("src"))))
        .collect()
}

/// For every crate the names of methods that libraries have, and those of our crates on which it depends.
fn methods_of_others(crates: &[(String, Crate)]) -> BTreeMap<String, BTreeSet<String>> {
    let others_of = |own: &String| -> BTreeSet<String> {
        let manifests = FOLDERS.map(|folder| Path::new(folder).join(own).join("Cargo.toml"));
        let mut manifests = manifests.iter().map(std::fs::read_to_string);
        let manifest = manifests.find_map(Result::ok).expect("a manifest");
        let needed = |name: &String| {
            let mut lines = manifest.lines();
            name != own
                && lines.any(|line| line.split(&[' ', '.', '='][..]).next() == Some(name.as_str()))
        };
        let others = crates.iter().filter(|(name, _)| needed(name));
        let ours = others.flat_map(|(_, sources)| sources.methods().into_keys());
        OTHERS.map(str::to_owned).into_iter().chain(ours).collect()
    };
    let all = crates.iter().map(|(name, _)| name);
    all.map(|name| (name.clone(), others_of(name))).collect()
}

#[test]
fn no_files_and_no_folders_use_each_other_in_a_circle() {
    let mut faults = Vec::new();
    let crates = crates();
    let others = methods_of_others(&crates);
    for (name, sources) in crates {
        let arrows = sources.arrows(&others[&name]);
        let folders: BTreeSet<Module> = sources
            .files
            .keys()
            .flat_map(|module| (0..module.len()).map(|k| module[..k].to_vec()))
            .collect();
        for folder in folders {
            let depth = folder.len();
            let mut own = BTreeMap::<String, BTreeSet<String>>::new();
            let mut reasons = BTreeMap::<(String, String), String>::new();
            for (from, targets) in &arrows {
                for (to, names) in targets {
                    let inside = from.starts_with(&folder) && to.starts_with(&folder);
                    if !inside || depth == 0 && (from.is_empty() || to.is_empty()) {
                        continue;
                    }
                    // A folder's own file is one of its entries.
                    let own_file = "(itself)".to_owned();
                    let (a, b) = (
                        from.get(depth).unwrap_or(&own_file),
                        to.get(depth).unwrap_or(&own_file),
                    );
                    let allowed = TOGETHER.iter().any(|(of, files, _)| {
                        let both = [from, to].map(|module| module.join("/"));
                        *of == name && both.iter().all(|file| files.contains(&file.as_str()))
                    });
                    if a != b && !allowed {
                        own.entry(a.clone()).or_default().insert(b.clone());
                        let names: Vec<_> = names.iter().cloned().collect();
                        let reason = format!("{} uses {}", from.join("/"), names.join(", "));
                        reasons.insert((a.clone(), b.clone()), reason);
                    }
                }
            }
            if let Some(circle) = cycle(&own) {
                let next = circle.iter().cycle().skip(1);
                let steps = circle.iter().zip(next);
                let steps = steps.map(|(a, b)| format!("  {}", reasons[&(a.clone(), b.clone())]));
                let steps: Vec<_> = steps.collect();
                faults.push(format!(
                    "{name}/{}:\n{}",
                    folder.join("/"),
                    steps.join("\n")
                ));
            }
        }
    }
    assert!(faults.is_empty(), "import cycles:\n{}", faults.join("\n"));
}

#[test]
fn no_room_of_the_core_uses_one_above_it() {
    let all = crates();
    let others = &methods_of_others(&all)["kinetostat"];
    let core = &all
        .iter()
        .find(|(name, _)| name == "kinetostat")
        .expect("the core")
        .1;
    let place = |room: &str| {
        let known = ROOMS.iter().position(|known| *known == room);
        known.unwrap_or_else(|| panic!("give '{room}' its place among the rooms"))
    };
    let mut drawn = 0;
    for (from, targets) in core.arrows(others) {
        for (to, names) in targets.iter().filter(|(to, _)| !to.is_empty()) {
            drawn += 1;
            let (own, used) = (place(&from[0]), place(&to[0]));
            assert!(
                used <= own,
                "{} uses {:?} of {}: an arrow that runs up",
                from.join("/"),
                names,
                to.join("/")
            );
        }
    }
    assert!(drawn > 200, "only {drawn} arrows were found");
}
