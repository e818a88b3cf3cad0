# Sourced: where Debian's packages come from here.

# The address of the Debian archive that apt's own configuration names; DEBIAN_MIRROR, where that is set, goes before it.
# Nothing if neither names one.
debian_mirror() {
    if [ -n "${DEBIAN_MIRROR:-}" ]; then
        printf '%s\n' "${DEBIAN_MIRROR%/}"
        return
    fi
    # Without lists apt does not know whose archive an address is.
    local archives
    archives=$(debian_archives)
    if [ -z "$archives" ]; then
        apt-get -qq update >/dev/null 2>&1 || true
        archives=$(debian_archives)
    fi
    head -n 1 <<<"${archives%/}"
}

debian_archives() {
    apt-get indextargets --format '$(ORIGIN)|$(LABEL)|$(REPO_URI)' 2>/dev/null |
        sed -n 's#^Debian|Debian|\(https\{0,1\}://.*[^/]\)/*$#\1#p' | sort -u
}
