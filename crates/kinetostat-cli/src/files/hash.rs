//! Hashes of files and texts.

use sha2::{Digest, Sha256};

/// FNV-1a of no bytes.
pub(crate) const FNV1A: u64 = 0xcbf2_9ce4_8422_2325;

/// FNV-1a of the bytes before, `hash`, and of these.
pub(crate) fn fnv1a(hash: u64, bytes: &[u8]) -> u64 {
    bytes.iter().fold(hash, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

pub(crate) fn sha256(bytes: &[u8]) -> String {
    hex(&Sha256::digest(bytes))
}

/// Hash of files: that of one, or of the hashes of all, which bytes that go from one file to the next change.
pub(crate) fn sha256_of_all(files: &[&[u8]]) -> String {
    match files {
        [one] => sha256(one),
        all => {
            let each: Vec<String> = all.iter().map(|file| sha256(file)).collect();
            sha256(each.concat().as_bytes())
        }
    }
}

/// A hash as it is written.
pub(crate) fn hex(hash: &[u8]) -> String {
    hash.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// FIPS 180-2, appendix B.1.
    #[test]
    fn the_hash_is_the_standard_one() {
        assert_eq!(
            sha256(b"abc"),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
        );
        assert_eq!(sha256_of_all(&[b"abc"]), sha256(b"abc"));
        assert_ne!(sha256_of_all(&[b"ab", b"c"]), sha256_of_all(&[b"a", b"bc"]));
    }
}
