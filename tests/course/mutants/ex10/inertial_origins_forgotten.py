# loses: 10.1
# Takes the places of the joints for those of the centres: the inertial origins are forgotten.
_describe = describe


def describe(urdf):
    root = ElementTree.fromstring(urdf)
    for link in root.findall("link"):
        origin = link.find("inertial/origin")
        if origin is not None:
            origin.set("xyz", "0 0 0")
    return _describe(ElementTree.tostring(root, encoding="unicode"))
