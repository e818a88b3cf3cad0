//! The C header that is checked in is the one that `src/capi/` says.

use std::path::Path;

#[test]
fn the_header_is_that_of_the_source() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = cbindgen::Config::from_root_or_default(root);
    let builder = cbindgen::Builder::new().with_config(config).with_src(root.join("src/capi/mod.rs"));
    let mut written = Vec::new();
    builder.generate().expect("the source can be read").write(&mut written);
    let written = String::from_utf8(written).expect("text");
    let path = root.join("include/irradia.h");
    if std::env::var_os("IRRADIA_WRITE_DOCS").is_some() {
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        std::fs::write(&path, &written).expect("the header can be written");
    }
    let held = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        held == written,
        "include/irradia.h is not what src/capi/ says: IRRADIA_WRITE_DOCS=1 cargo test --test it header writes it"
    );
}
