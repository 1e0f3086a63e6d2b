#!/usr/bin/python3
"""Prints the SPDX list of a release: spdx.py FOLDER VERSION EPOCH CONTENTS.

It describes every file of the FOLDER, and every Debian package whose libraries or compiled headers are in one of them, as
CONTENTS says: lines of file, "libraries" or "headers", Debian, package, version, source and version of the source. The
licences of a package are the words of its copyright file, in FOLDER/licences; their short names stand beside them where
that file is machine-readable.
"""

import hashlib
import json
import pathlib
import re
import sys
import time
import urllib.parse

FOLDER, VERSION, EPOCH, CONTENTS = pathlib.Path(sys.argv[1]), sys.argv[2], int(sys.argv[3]), sys.argv[4]
CREATED = time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(EPOCH))
DEBIANS = {"debian-12": "bookworm", "debian-13": "trixie"}


def identifier(*parts):
    return "-".join(re.sub(r"[^A-Za-z0-9.]+", "-", part.replace("+", "plus")) for part in parts)


def short_names(text):
    """Of the licences that a copyright file names, as Debian calls them; none if it is not machine-readable."""
    if not re.search(r"^Format: *https?://\S*copyright-format", text, re.M):
        return []
    return sorted(set(re.findall(r"^License: *(\S.*?) *$", text, re.M)))


def file_of_release(path):
    name = str(path.relative_to(FOLDER))
    return {
        "SPDXID": identifier("SPDXRef", name), "name": path.name, "packageFileName": name, "versionInfo": VERSION,
        "supplier": "NOASSERTION", "downloadLocation": "NOASSERTION", "filesAnalyzed": False,
        "checksums": [{"algorithm": "SHA256", "checksumValue": hashlib.sha256(path.read_bytes()).hexdigest()}],
        "licenseConcluded": "GPL-3.0-or-later", "licenseDeclared": "GPL-3.0-or-later",
        "copyrightText": "the authors of bernal, and of what it contains"}


def package_of_debian(debian, package, version, source, source_version):
    names = short_names((FOLDER / "licences" / debian / package).read_text())
    purl = (f"pkg:deb/debian/{urllib.parse.quote(package)}@{urllib.parse.quote(version)}?arch=amd64&distro={DEBIANS[debian]}"
            .replace("%2B", "+"))
    return {
        "SPDXID": identifier("SPDXRef", debian, package), "name": package, "versionInfo": version,
        "supplier": "Organization: Debian", "filesAnalyzed": False,
        "downloadLocation": f"https://snapshot.debian.org/package/{urllib.parse.quote(source)}/"
                            f"{urllib.parse.quote(source_version)}/",
        "sourceInfo": f"Debian's source package {source} {source_version}",
        "licenseConcluded": "NOASSERTION", "licenseDeclared": identifier("LicenseRef", debian, package),
        "licenseComments": "Debian's copyright file names " + ("; ".join(names) if names else "no licence by a short name"),
        "copyrightText": "NOASSERTION",
        "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl", "referenceLocator": purl}]}


def main():
    files = [file_of_release(path) for path in sorted(FOLDER.rglob("*"))
             if path.is_file() and "licences" not in path.relative_to(FOLDER).parts]
    rows = sorted({tuple(line.split("\t")) for line in pathlib.Path(CONTENTS).read_text().splitlines()})
    packages = {}
    for _, _, debian, package, *versions in rows:
        packages[debian, package] = package_of_debian(debian, package, *versions)
    relations = [("SPDXRef-DOCUMENT", "DESCRIBES", file["SPDXID"]) for file in files]
    relations += [(identifier("SPDXRef", file), "CONTAINS" if how == "libraries" else "STATIC_LINK",
                   packages[debian, package]["SPDXID"]) for file, how, debian, package, *_ in rows]
    described = {file["SPDXID"] for file in files}
    assert all(one == "SPDXRef-DOCUMENT" or one in described for one, _, _ in relations)
    assert len(described) + len({p["SPDXID"] for p in packages.values()}) == len(files) + len(packages)
    print(json.dumps({
        "spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": f"bernal-{VERSION}",
        # Of what is described, so that two releases never share one.
        "documentNamespace": f"urn:sha256:{hashlib.sha256(json.dumps(files).encode()).hexdigest()}",
        "creationInfo": {"created": CREATED, "creators": ["Tool: cmake/release"]},
        "packages": files + [packages[key] for key in sorted(packages)],
        "relationships": [{"spdxElementId": a, "relationshipType": kind, "relatedSpdxElement": b} for a, kind, b in relations],
        "hasExtractedLicensingInfos": [
            {"licenseId": identifier("LicenseRef", debian, package), "name": f"copyright file of {package}, {debian}",
             "extractedText": (FOLDER / "licences" / debian / package).read_text()} for debian, package in sorted(packages)],
    }, indent=1, ensure_ascii=False))


if __name__ == "__main__":
    main()
