"""Messages on the bus: protobuf, package `berth`; `make schemas` regenerates the modules beside the .proto files."""
