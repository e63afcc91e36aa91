# Shared by the scripts of this folder; sourced, not run.
set -euo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
cd "$root"
jobs="$(nproc)"

# What cablefit needs of Debian 12 to be built (tinyxml2 only to read URDF files, help2man only for
# manual pages), what its tests need on top (a browser for the HTML reports, a judge of arms, a
# spelling dictionary), and what steps of scripts/check need (one string for each step).
build_packages=(g++ cmake ninja-build pkg-config libeigen3-dev libceres-dev libcli11-dev
                nlohmann-json3-dev libfmt-dev libfast-float-dev zlib1g-dev libzstd-dev libssl-dev
                libtinyxml2-dev catch2 npm help2man)
test_packages=(nodejs chromium liborocos-kdl-dev hunspell hunspell-en-gb)
fuzz_packages=(clang-14 libclang-rt-14-dev)
declare -A step_packages=([format]=clang-format-14 [readme]="python3 hunspell hunspell-en-gb"
                          [tidy]=clang-tidy-14 [changed]=clang-tidy-14
                          [sanitize]=chromium)
# Packages whose program may as well come from elsewhere, and are then not wanted: Debian's npm cannot
# stand beside a node of nodesource.org.
declare -A program_of=([npm]=npm [nodejs]=node [chromium]=chromium)

# Says what it runs, and runs it.
show() {
  printf '\n$'
  printf ' %q' "$@"
  printf '\n'
  "$@"
}

fail() {
  printf '%s: %s\n' "${0##*/}" "$*" >&2
  exit 1
}

# configure FOLDER BUILD_TYPE OPTION...
configure() {
  show cmake --log-level=WARNING -S . -B "$1" -G Ninja -DCMAKE_BUILD_TYPE="$2" \
    -DCABLEFIT_TOGETHER="${CABLEFIT_TOGETHER:-OFF}" \
    -DCABLEFIT_WARNINGS_AS_ERRORS="${CABLEFIT_WARNINGS_AS_ERRORS:-OFF}" "${@:3}"
}

# build FOLDER TARGET...
build() {
  show cmake --build "$1" --parallel "$jobs" ${2:+--target "${@:2}"}
}

# With -O2, because tests simulate and fit a lot, but without NDEBUG: the assertions here, in Eigen
# and in the standard library are what a test can still trip over when the numbers look right.
configure_with_assertions() {
  configure "$1" RelWithDebInfo -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="$2 -D_GLIBCXX_ASSERTIONS" \
    "${@:3}"
}

# Installs those of the named packages that are missing; does nothing, quickly, when none is.
install_packages() {
  local package as_root=() missing=()
  if ! command -v dpkg-query >/dev/null; then
    printf 'Not a Debian system, so nothing is installed. cablefit needs what Debian calls:\n  %s\n' \
      "$*" >&2
    return
  fi
  for package in "$@"; do
    [[ -v "program_of[$package]" ]] && command -v "${program_of[$package]}" >/dev/null && continue
    [[ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" == installed ]] ||
      missing+=("$package")
  done
  ((${#missing[@]})) || return 0

  if ((EUID != 0)); then
    as_root=(sudo)
    command -v sudo >/dev/null || fail "packages are missing, and this is neither root nor is there" \
      "sudo; as root, run: apt-get install --no-install-recommends ${missing[*]}"
  fi
  command -v apt-get >/dev/null || fail "no apt-get here; please install: ${missing[*]}"
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive
             apt-get -y -q -o DPkg::Lock::Timeout=300)
  local install=("${apt[@]}" install --no-install-recommends "${missing[@]}")
  # The lists of packages may never have been fetched, or be too old to find the files.
  if ! apt-get -s install "${missing[@]}" &>/dev/null || ! show "${install[@]}" </dev/null; then
    show "${apt[@]}" update </dev/null
    show "${install[@]}" </dev/null
  fi
}
