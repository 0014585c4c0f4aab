//! Names of programs.

/// The name by which a program is called, in capitals: that of its file without ending and marks of the control.
pub(super) fn program_name(file: &str) -> Vec<u8> {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    let name = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    let name = name.to_ascii_uppercase();
    let name = name.strip_prefix("_N_").unwrap_or(&name);
    let name = name
        .strip_suffix("_SPF")
        .or(name.strip_suffix("_MPF"))
        .unwrap_or(name);
    name.as_bytes().to_vec()
}
