# An image of bernal, made of a release, in whose folder this file lies beside the archive:
#
#   docker build --tag bernal build/release-VERSION
#   docker run --rm --user "$(id -u):$(id -g)" --volume "$PWD:/work" bernal pack mine.toml
FROM debian:12-slim
ADD bernal-*-linux-x86_64.tar.xz /opt/
RUN ln -s /opt/bernal-*/bin/bernal /usr/local/bin/bernal
WORKDIR /work
ENTRYPOINT ["bernal"]
