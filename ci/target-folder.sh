# Sourced before a script leaves the caller's folder: CARGO_TARGET_DIR as cargo would take it there. Cargo refuses an empty one.
case "${CARGO_TARGET_DIR-}" in
    '') unset CARGO_TARGET_DIR ;;
    /*) ;;
    *) export CARGO_TARGET_DIR="$PWD/$CARGO_TARGET_DIR" ;;
esac

# Where cargo builds, by whatever it is told: the variable, the command line's configuration, a file of configuration.
target_folder() {
    cargo metadata --no-deps --format-version 1 --quiet |
        python3 -c 'import json, sys; print(json.load(sys.stdin)["target_directory"])'
}
