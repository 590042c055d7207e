#!/bin/sh
# Makes what Dask needs to encrypt a cluster and to let in only those who hold its key:
#   sh deploy/certificates.sh FOLDER
# An authority of its own (ca.pem), one certificate with its key for all machines (cert.pem, key.pem), and
# dask.yaml, Dask's settings. Copy the folder to every machine by a safe way (scp), and say where it is:
#   export DASK_CONFIG=FOLDER
# Where it has another place there, run this script there again: what exists is kept, dask.yaml written anew.
# The authority's own key is thrown away: this certificate is the only one that it has ever signed.
set -eu
[ $# -eq 1 ] || { echo "usage: sh certificates.sh FOLDER" >&2; exit 2; }
command -v openssl >/dev/null || { echo "error: openssl is needed: install it with your system's packages" >&2; exit 2; }
umask 077
mkdir -p "$1"
cd "$1"

days=825
key="-newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes"
if [ ! -f cert.pem ]; then
    # shellcheck disable=SC2086
    openssl req -x509 $key -days $days -subj "/CN=botschool cluster authority" \
        -addext "keyUsage=critical,keyCertSign,cRLSign" -keyout ca-key.pem -out ca.pem
    # shellcheck disable=SC2086
    openssl req $key -subj "/CN=botschool cluster" -keyout key.pem -out request.pem
    printf '%s\n' "basicConstraints=critical,CA:FALSE" "keyUsage=critical,digitalSignature" \
        "extendedKeyUsage=serverAuth,clientAuth" "subjectKeyIdentifier=hash" \
        "authorityKeyIdentifier=keyid" >extensions
    openssl x509 -req -in request.pem -CA ca.pem -CAkey ca-key.pem -CAcreateserial -days $days \
        -extfile extensions -out cert.pem
    rm -f ca-key.pem request.pem extensions ca.srl
fi

here=$(pwd)
cat >dask.yaml <<END
distributed:
  comm:
    require-encryption: true
    tls:
      ca-file: "$here/ca.pem"
      scheduler:
        cert: "$here/cert.pem"
        key: "$here/key.pem"
      worker:
        cert: "$here/cert.pem"
        key: "$here/key.pem"
      client:
        cert: "$here/cert.pem"
        key: "$here/key.pem"
  worker:
    profile:
      enabled: false    # Dask's look into each worker a hundred times a second, which costs it some percent
END
echo "Written: $here (export DASK_CONFIG=$here)"
