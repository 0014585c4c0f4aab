//! Which file uses which: no import cycle in any crate, and in the core no room uses one above it.
//!
//! The arrows are read from the sources: `use` lines and paths, in macros too; re-exports are followed to where the
//! item is defined. Test modules are left out. Methods that a higher room adds to a type of a lower one draw no arrow
//! where they are called; rooms name their types, so that such a call shows in a path sooner or later.

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
const TOGETHER: [(&str, &[&str], &str); 0] = [];

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

    /// What every module uses of which other module.
    fn arrows(&self) -> BTreeMap<Module, BTreeMap<Module, BTreeSet<String>>> {
        let mut arrows = BTreeMap::<_, BTreeMap<_, BTreeSet<_>>>::new();
        // The root only declares and re-exports.
        for (module, file) in self.files.iter().filter(|(module, _)| !module.is_empty()) {
            let mut paths = Paths(Vec::new());
            paths.visit_file(file);
            for path in paths.0 {
                let Some(used) = self.defined_in(module, &path, 0) else {
                    continue;
                };
                if used != *module {
                    let names = arrows.entry(module.clone()).or_default().entry(used);
                    names.or_default().insert(path.join("::"));
                }
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

/// All paths of a file.
struct Paths(Vec<Vec<String>>);

impl<'a> Visit<'a> for Paths {
    fn visit_item_mod(&mut self, item: &'a syn::ItemMod) {
        if !is_test(&item.attrs) {
            syn::visit::visit_item_mod(self, item);
        }
    }

    fn visit_item_use(&mut self, item: &'a syn::ItemUse) {
        self.0
            .extend(flat(&item.tree).into_iter().map(|(path, _)| path));
    }

    fn visit_path(&mut self, path: &'a syn::Path) {
        if path.segments.len() > 1 {
            let parts = path.segments.iter().map(|part| part.ident.to_string());
            self.0.push(parts.collect());
        }
        syn::visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, item: &'a syn::Macro) {
        let text = item.tokens.to_string().replace(' ', "");
        for start in text.match_indices("crate::").map(|(at, _)| at) {
            let is_part = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
            let path: String = text[start..].chars().take_while(|c| is_part(*c)).collect();
            let parts = path.split("::").filter(|part| !part.is_empty());
            self.0.push(parts.map(str::to_owned).collect());
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

fn crates() -> Vec<(String, Crate)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates");
    let mut found: Vec<_> = std::fs::read_dir(&root)
        .expect("the folder of the crates")
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

#[test]
fn no_files_and_no_folders_use_each_other_in_a_circle() {
    let mut faults = Vec::new();
    for (name, sources) in crates() {
        let arrows = sources.arrows();
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
                    if !inside || from.len() <= depth || to.len() <= depth {
                        continue;
                    }
                    let (a, b) = (&from[depth], &to[depth]);
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
    for (from, targets) in core.arrows() {
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
